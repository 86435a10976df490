// SPDX-License-Identifier: MIT
// The plain product of two finite complex numbers. std::complex's operator* checks for infinities
// by a library call per product, which costs more than the product.
#pragma once
#include <complex>

namespace knotwave::dsp {

inline std::complex<double> product(std::complex<double> a, std::complex<double> b) noexcept {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

}  // namespace knotwave::dsp
