// SPDX-License-Identifier: MIT
// How far a polynomial piece is from a quotient of polynomials, as a Bernstein form: its hull
// proves a bound. Private to curves. [control]
#pragma once
#include <span>
#include <vector>

#include "double_double.h"

namespace knotwave::curves {

/// A polynomial on [0, 1] by sum a_j t^j (1 - t)^(n - j): Bernstein coefficients times C(n, j).
/// Products are plain convolutions.
using ScaledBernstein = std::vector<DoubleDouble>;  ///< [n + 1]

/// C(n, j): the polynomial 1 as one of degree n.
ScaledBernstein scaled_one(int degree);
ScaledBernstein scaled(std::span<const DoubleDouble> bernstein);
/// c[0] + c[1] t + ... as one of degree c.size() - 1.
ScaledBernstein scaled_powers(std::span<const double> c);
ScaledBernstein convolved(std::span<const DoubleDouble> a, std::span<const DoubleDouble> b);

/// A piece and its curve over one part, all of one degree: the curve is value / weight, and
/// gap / weight is how far the piece is below it.
struct ErrorForm {
  ScaledBernstein gap;
  ScaledBernstein value;
  ScaledBernstein weight;  ///< above 0
};

struct ErrorLimits {
  double low = 0, high = 0;  ///< hull, which holds the curve; the piece is clamped to it
  double found = 0;          ///< an error seen before: the bound need not be much smaller
  double settled = 0;        ///< nor below this
  double most = 0;           ///< infinity is returned as soon as the error is known to be above
};

/// A bound on |piece - curve|, at most kBoundRoom times the largest error, `found` or `settled`
/// unless the part is too hard, which ends in a larger bound or infinity: at most kMostParts parts.
/// gap_j / weight_j hold gap / weight, ever closer as parts are halved (de Casteljau). Doubles do
/// for that: halves are means, so what they round is small against the weight at the same place.
double error_bound(const ErrorForm& form, const ErrorLimits& limits);

inline constexpr double kBoundRoom = 1.04;
inline constexpr int kMostParts = 2000;

}  // namespace knotwave::curves
