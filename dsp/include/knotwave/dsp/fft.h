// SPDX-License-Identifier: MIT
// A small double-precision FFT whose twiddles come from our own sin/cos, so it gives the same bits
// everywhere. [control] Stockham radix 2; size a power of two.
#pragma once
#include <complex>
#include <vector>

namespace knotwave::dsp {

/// Forward (sign -1) or inverse (sign +1, not scaled) transform in place. size() must be a power
/// of two >= 1. O(n log n).
void fft(std::vector<std::complex<double>>& values, bool inverse);

/// c[n], n = 0..max_harmonic, of y(t) = sum_n c[n] e^{2 pi i n t} + conj for one real cycle of
/// samples; samples.size() must be a power of two > 2 * max_harmonic.
std::vector<std::complex<double>> harmonics_of_cycle(const std::vector<double>& samples,
                                                     int max_harmonic);

}  // namespace knotwave::dsp
