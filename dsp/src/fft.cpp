// SPDX-License-Identifier: MIT
#include "knotwave/dsp/fft.h"

#include <bit>

#include "knotwave/base/elementary.h"
#include "knotwave/base/rt.h"

#include "complex_product.h"

namespace knotwave::dsp {
namespace {

using Complex = std::complex<double>;

/// e^{2 pi i x}, x in cycles.
Complex turn(double x) {
  const base::SinCos value = base::sin_cos_cycles(x);
  return {value.cos, value.sin};
}

/// Chirp e^{-i pi j^2 / n}. j^2 is reduced modulo 2n in integers, so long chirps stay exact.
Complex chirp(std::size_t j, std::size_t n) {
  const auto square = (std::uint64_t(j) * std::uint64_t(j)) % (2 * std::uint64_t(n));
  return turn(-static_cast<double>(square) / static_cast<double>(2 * n));
}

/// Bluestein: with jk = (j^2 + k^2 - (k - j)^2) / 2 the transform is a convolution with a chirp.
void forward_any_length(std::vector<Complex>& values) {
  const std::size_t n = values.size();
  Fft transform(std::bit_ceil(2 * n - 1));
  std::vector<Complex> a(transform.size()), b(transform.size());
  for (std::size_t j = 0; j < n; ++j) {
    const Complex w = chirp(j, n);
    a[j] = product(values[j], w);
    b[j] = std::conj(w);
    b[(transform.size() - j) % transform.size()] = std::conj(w);
  }
  transform.forward(a);
  transform.forward(b);
  for (std::size_t k = 0; k < a.size(); ++k) a[k] = product(a[k], b[k]);
  transform.inverse(a);
  const double scale = 1.0 / static_cast<double>(transform.size());
  for (std::size_t k = 0; k < n; ++k) values[k] = product(a[k], chirp(k, n)) * scale;
}

}  // namespace

Fft::Fft(std::size_t size) : size_(size), twiddles_(size / 2), work_(size) {
  KNOTWAVE_ASSERT(std::has_single_bit(size));
  for (std::size_t j = 0; j < twiddles_.size(); ++j) {
    twiddles_[j] = turn(-static_cast<double>(j) / static_cast<double>(size));
  }
}

template <bool kInverse>
void Fft::transform(std::span<Complex> values) {
  KNOTWAVE_ASSERT(values.size() == size_);
  Complex* from = values.data();
  Complex* to = work_.data();
  for (std::size_t half = size_ / 2, stride = 1; half >= 1; half /= 2, stride *= 2) {
    for (std::size_t p = 0; p < half; ++p) {
      const Complex w = kInverse ? std::conj(twiddles_[p * stride]) : twiddles_[p * stride];
      const Complex* a = from + stride * p;
      const Complex* b = a + stride * half;
      Complex* sum = to + 2 * stride * p;
      Complex* difference = sum + stride;
      for (std::size_t q = 0; q < stride; ++q) {
        sum[q] = a[q] + b[q];
        difference[q] = product(a[q] - b[q], w);
      }
    }
    std::swap(from, to);
  }
  if (from != values.data()) std::copy(work_.begin(), work_.end(), values.begin());
}

void Fft::forward(std::span<Complex> values) { transform<false>(values); }
void Fft::inverse(std::span<Complex> values) { transform<true>(values); }

void fft(std::vector<Complex>& values, bool inverse) {
  if (values.size() <= 1) return;
  if (std::has_single_bit(values.size())) {
    Fft transform(values.size());
    inverse ? transform.inverse(values) : transform.forward(values);
    return;
  }
  // The inverse is the forward transform of the conjugate, conjugated.
  if (inverse) {
    for (Complex& value : values) value = std::conj(value);
  }
  forward_any_length(values);
  if (inverse) {
    for (Complex& value : values) value = std::conj(value);
  }
}

std::vector<Complex> harmonics_of_cycle(std::span<const double> samples, int max_harmonic) {
  std::vector<Complex> spectrum(samples.begin(), samples.end());
  fft(spectrum, false);
  std::vector<Complex> harmonics(static_cast<std::size_t>(max_harmonic) + 1);
  const double scale = 1.0 / static_cast<double>(samples.size());
  for (std::size_t n = 0; n < harmonics.size() && 2 * n < samples.size(); ++n) {
    harmonics[n] = spectrum[n] * scale;
  }
  return harmonics;
}

CycleSynthesis::CycleSynthesis(std::size_t size)
    : half_(size / 2), twiddles_(size / 2), work_(size / 2) {
  for (std::size_t k = 0; k < twiddles_.size(); ++k) {
    twiddles_[k] = turn(static_cast<double>(k) / static_cast<double>(size));
  }
}

void CycleSynthesis::render(std::span<const Complex> harmonics, std::span<double> out) {
  const std::size_t half = half_.size();
  KNOTWAVE_ASSERT(harmonics.size() <= half && out.size() == 2 * half);
  const auto spectrum = [&](std::size_t n) {
    return n < harmonics.size() ? harmonics[n] : Complex();
  };
  // Even samples are the real part of a transform of half the size, odd ones the imaginary part.
  work_[0] = Complex(spectrum(0).real(), spectrum(0).real());
  for (std::size_t k = 1; k < half; ++k) {
    const Complex low = spectrum(k);
    const Complex high = std::conj(spectrum(half - k));
    const Complex odd = product(low - high, twiddles_[k]);
    work_[k] = low + high + Complex(-odd.imag(), odd.real());
  }
  half_.inverse(work_);
  for (std::size_t k = 0; k < half; ++k) {
    out[2 * k] = work_[k].real();
    out[2 * k + 1] = work_[k].imag();
  }
}

}  // namespace knotwave::dsp
