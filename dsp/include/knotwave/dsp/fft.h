// SPDX-License-Identifier: MIT
// A small double-precision FFT whose twiddles come from our own sin/cos, so it gives the same bits
// everywhere. [control] Stockham radix 2 for powers of two, Bluestein's chirp for other lengths.
// Sources: C. Van Loan, Computational Frameworks for the FFT, 1.7; L. Bluestein, A linear filtering
// approach to the computation of the discrete Fourier transform, 1970.
#pragma once
#include <complex>
#include <span>
#include <vector>

namespace knotwave::dsp {

/// A transform of one size with its twiddles. Not thread-safe: it owns its work space.
class Fft {
 public:
  /// size >= 1, a power of two. O(size).
  explicit Fft(std::size_t size);

  std::size_t size() const noexcept { return size_; }

  /// values[k] = sum_j values[j] e^{-2 pi i j k / size}, in place, values.size() == size(); inverse
  /// has the other sign and no scale. O(size log size). Error below 1e-15 log2(size) rms, relative.
  void forward(std::span<std::complex<double>> values);
  void inverse(std::span<std::complex<double>> values);

 private:
  template <bool kInverse>
  void transform(std::span<std::complex<double>> values);
  std::size_t size_;
  std::vector<std::complex<double>> twiddles_;  ///< e^{-2 pi i j / size}, j < size / 2
  std::vector<std::complex<double>> work_;
};

/// Forward or inverse transform of any length >= 1 in place, not scaled. O(n log n).
void fft(std::vector<std::complex<double>>& values, bool inverse);

/// c[n], n = 0..max_harmonic, of y(t) = c[0] + sum_n c[n] e^{2 pi i n t} + conj for one real cycle
/// of samples at t = k / size. Harmonics at or above half the length are 0: a cycle of N samples
/// determines none. Any length >= 1.
std::vector<std::complex<double>> harmonics_of_cycle(std::span<const double> samples,
                                                     int max_harmonic);

/// One cycle of `size` samples (a power of two > 2 * (c.size() - 1)) of the c above.
class CycleSynthesis {
 public:
  explicit CycleSynthesis(std::size_t size);
  void render(std::span<const std::complex<double>> harmonics, std::span<double> out);

 private:
  Fft half_;
  std::vector<std::complex<double>> twiddles_;  ///< e^{2 pi i k / size}, k < size / 2
  std::vector<std::complex<double>> work_;
};

}  // namespace knotwave::dsp
