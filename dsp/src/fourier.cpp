// SPDX-License-Identifier: MIT
// Fourier coefficients of piecewise polynomials. Each piece p(t), t in [0, 1], that lies at
// start + width * t of the cycle adds width * e^{-2 pi i n start} * integral p(t) e^{-i theta t}
// dt, theta = 2 pi n width. By parts the integral is a sum over derivatives at the ends,
//   sum_j (p^(j)(0) - p^(j)(1) e^{-i theta}) / (i theta)^(j + 1),
// exact but cancelling for small theta, where 16-point Gauss-Legendre is exact to rounding.
#include <algorithm>
#include <array>
#include <cmath>

#include "knotwave/base/elementary.h"
#include "knotwave/base/gauss_legendre.h"
#include "knotwave/dsp/wave_tables.h"

#include "complex_product.h"

namespace knotwave::dsp {
namespace {

using Complex = std::complex<double>;

constexpr double kPi = 3.14159265358979323846;
constexpr int kMaxDegree = curves::kMaxPieceDegree;
/// Below this many cycles of the harmonic in a piece: Gauss-Legendre (theta < 3 pi).
constexpr double kGaussCycles = 1.5;

Complex unit(double cycles) {
  const base::SinCos value = base::sin_cos_cycles(cycles);
  return {value.cos, value.sin};
}

double horner(std::span<const double> coefficients, double t) {
  double value = 0;
  for (std::size_t k = coefficients.size(); k-- > 0;) value = value * t + coefficients[k];
  return value;
}

struct Piece {
  std::span<const double> coefficients;  ///< ascending powers of t
  double start;                          ///< in cycles
  double width;
};

/// Harmonics 1..last by quadrature. e^{-2 pi i n x} of each node is a running power: its error
/// grows as n, to 1e-12 at the largest n, and is weighted by the piece's short width.
void add_by_quadrature(const Piece& piece, std::size_t last, std::span<Complex> out) {
  for (const base::GaussNode& node : base::kGaussLegendre16) {
    for (const double sign : {-1.0, 1.0}) {
      const double t = 0.5 + sign * node.distance;
      const double amount = horner(piece.coefficients, t) * node.weight * piece.width;
      const Complex step = unit(-(piece.start + piece.width * t));
      Complex power(amount, 0);
      for (std::size_t n = 1; n <= last; ++n) {
        power = product(power, step);
        out[n] += power;
      }
    }
  }
}

/// e^{-2 pi i n x} for n = 0, 1, ...: sixteen by sin and cos, then sixteen running products side by
/// side, whose error after 2048 is 128 roundings.
void fill_turns(double x, std::span<Complex> turns) {
  constexpr std::size_t kChains = 16;
  const Complex step = unit(-static_cast<double>(kChains) * x);
  for (std::size_t n = 0; n < turns.size(); ++n) {
    turns[n] = n < kChains ? unit(-static_cast<double>(n) * x) : product(turns[n - kChains], step);
  }
}

/// p^(j)(0) and p^(j)(1) for every j, with the signs of (-i)^(j + 1): j = 0, 2, ... give the
/// imaginary part of the sum, j = 1, 3, ... the real part.
struct EndDerivatives {
  std::array<double, (kMaxDegree + 1) / 2> imaginary{}, real{};

  /// sum_j p^(j) / (i theta)^(j + 1)
  Complex sum(double inverse_theta) const {
    const double square = inverse_theta * inverse_theta;
    double re = 0, im = 0;
    for (std::size_t k = real.size(); k-- > 0;) {
      re = re * square + real[k];
      im = im * square + imaginary[k];
    }
    return {re * square, im * inverse_theta};
  }
};

struct BothEnds {
  EndDerivatives at0, at1;
};
BothEnds end_derivatives(std::span<const double> coefficients) {
  std::array<double, kMaxDegree + 1> p{};
  std::copy(coefficients.begin(), coefficients.end(), p.begin());
  BothEnds ends;
  for (std::size_t j = 0, size = coefficients.size(); size > 0; ++j, --size) {
    const double sign = j % 4 < 2 ? -1 : 1;  // -i, -1, i, 1
    const double at0 = sign * p[0];
    const double at1 = sign * horner(std::span(p).first(size), 1.0);
    (j % 2 == 0 ? ends.at0.imaginary : ends.at0.real)[j / 2] = at0;
    (j % 2 == 0 ? ends.at1.imaginary : ends.at1.real)[j / 2] = at1;
    for (std::size_t k = 1; k < size; ++k) p[k - 1] = p[k] * static_cast<double>(k);
  }
  return ends;
}

/// Harmonics first.. from the derivatives at both ends; left and right are e^{-2 pi i n x} there.
void add_by_parts(const Piece& piece, std::size_t first, std::span<const Complex> left,
                  std::span<const Complex> right, std::span<Complex> out) {
  const BothEnds ends = end_derivatives(piece.coefficients);
  for (std::size_t n = first; n < out.size(); ++n) {
    const double inverse_theta = 1.0 / (2 * kPi * static_cast<double>(n) * piece.width);
    const Complex at0 = product(ends.at0.sum(inverse_theta), left[n]);
    const Complex at1 = product(ends.at1.sum(inverse_theta), right[n]);
    out[n] += (at0 - at1) * piece.width;
  }
}

double mean(std::span<const double> coefficients) {
  double sum = 0;
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    sum += coefficients[k] / static_cast<double>(k + 1);
  }
  return sum;
}

}  // namespace

std::vector<Complex> fourier_coefficients(const curves::CurveProgram& cycle, int coordinate,
                                          int max_harmonic) {
  KNOTWAVE_ASSERT(!cycle.is_rational() && coordinate < cycle.dim() && max_harmonic >= 0);
  std::vector<Complex> out(static_cast<std::size_t>(max_harmonic) + 1);
  std::vector<Complex> left(out.size(), Complex(1, 0)), right(out.size(), Complex(1, 0));
  const double period = cycle.u_max() - cycle.u_min();
  const std::span<const double> breaks = cycle.breaks();
  for (int k = 0; k < cycle.piece_count(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Piece piece = {cycle.coefficients(k, coordinate), (breaks[i] - cycle.u_min()) / period,
                         (breaks[i + 1] - breaks[i]) / period};
    const double end = (breaks[i + 1] - cycle.u_min()) / period;
    const auto split = static_cast<std::size_t>(
        std::min(static_cast<double>(out.size()), kGaussCycles / piece.width + 1));
    fill_turns(end, right);
    out[0] += mean(piece.coefficients) * piece.width;
    add_by_quadrature(piece, split - 1, out);
    add_by_parts(piece, split, left, right, out);
    left.swap(right);
  }
  return out;
}

}  // namespace knotwave::dsp
