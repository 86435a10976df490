// SPDX-License-Identifier: MIT
// Coherent, window-free measuring: with f0 = k fs / N, k odd, N a power of two, every harmonic and
// every alias of an order below N has a bin of its own, so nothing leaks and nothing hides.
#pragma once
#include <complex>
#include <span>
#include <vector>

namespace knotwave::support {

inline constexpr int kCoherentSize = 1 << 16;

/// The odd k whose k * rate_hz / N is nearest to frequency_hz.
int coherent_bin(double frequency_hz, double rate_hz, int size = kCoherentSize);

/// Complex amplitudes [size / 2 + 1]: a sine of amplitude 1 on bin b gives |lines[b]| = 1.
std::vector<std::complex<double>> line_spectrum(std::span<const float> samples);
std::vector<std::complex<double>> line_spectrum(std::span<const double> samples);

/// 20 log10, -400 for 0.
double decibels(double amplitude);

struct CoherentReport {
  double worst_db = -400;      ///< strongest line that is no harmonic of bin k, dBFS
  double worst_hz = 0;         ///< where it is
  double worst_18k_db = -400;  ///< the same below 18 kHz
  double worst_16k_db = -400;  ///< the same below 16 kHz
  double passband_db = 0;      ///< largest |level error| of a harmonic at or below 18 kHz
  int passband_harmonics = 0;  ///< how many were compared
};

/// `exact` are c[n] of y(t) = sum_n c[n] e^{2 pi i n t} + conj; harmonics below -90 dBFS are too
/// near the rounding of float samples for a ratio and are not compared. Empty: none are.
CoherentReport measure_coherent(std::span<const float> samples, int bin, double rate_hz,
                                std::span<const std::complex<double>> exact);

}  // namespace knotwave::support
