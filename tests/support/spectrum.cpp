// SPDX-License-Identifier: MIT
#include "support/spectrum.h"

#include <algorithm>
#include <cmath>

#include "knotwave/dsp/fft.h"

namespace knotwave::support {
namespace {

using Complex = std::complex<double>;

std::vector<Complex> lines_of(std::vector<Complex> samples) {
  const auto size = samples.size();
  dsp::fft(samples, false);
  samples.resize(size / 2 + 1);
  for (Complex& line : samples) line *= 2.0 / static_cast<double>(size);
  samples.front() *= 0.5;
  samples.back() *= 0.5;
  return samples;
}

}  // namespace

int coherent_bin(double frequency_hz, double rate_hz, int size) {
  return 2 * static_cast<int>(std::lround((frequency_hz / rate_hz * size - 1) / 2)) + 1;
}

std::vector<Complex> line_spectrum(std::span<const float> samples) {
  return lines_of({samples.begin(), samples.end()});
}

std::vector<Complex> line_spectrum(std::span<const double> samples) {
  return lines_of({samples.begin(), samples.end()});
}

double decibels(double amplitude) { return amplitude > 1e-20 ? 20 * std::log10(amplitude) : -400; }

CoherentReport measure_coherent(std::span<const float> samples, int bin, double rate_hz,
                                std::span<const Complex> exact) {
  const std::vector<Complex> lines = line_spectrum(samples);
  const double bin_hz = rate_hz / static_cast<double>(samples.size());
  CoherentReport report;
  for (std::size_t b = 0; b < lines.size(); ++b) {
    const double hz = static_cast<double>(b) * bin_hz;
    const double db = decibels(std::abs(lines[b]));
    const auto harmonic = b / static_cast<std::size_t>(bin);
    if (b == 0 || b % static_cast<std::size_t>(bin) != 0) {
      if (db > report.worst_db) report.worst_db = db, report.worst_hz = hz;
      if (hz < 18000) report.worst_18k_db = std::max(report.worst_18k_db, db);
      if (hz < 16000) report.worst_16k_db = std::max(report.worst_16k_db, db);
    } else if (hz <= 18000 && harmonic < exact.size()) {
      const double expected_db = decibels(2 * std::abs(exact[harmonic]));
      if (expected_db < -90) continue;
      report.passband_db = std::max(report.passband_db, std::abs(db - expected_db));
      ++report.passband_harmonics;
    }
  }
  return report;
}

}  // namespace knotwave::support
