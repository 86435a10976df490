// SPDX-License-Identifier: MIT
// Areas of rational functions and lengths of paths, by Gauss-Legendre with a proved error. Private
// to curves. [control]
// Source: Trefethen, Approximation Theory and Approximation Practice, 19 (quadrature of functions
// that are analytic in a Bernstein ellipse).
//
// Why 16 nodes are enough. Let f be analytic, and |f| <= M, in the ellipse with foci -1 and 1 and
// half axes of sum 4. Its Chebyshev coefficients are below 2 M 4^-k; the rule is exact to degree
// 31, right by symmetry for odd k, and at most 2 + 2 / (k^2 - 1) wrong on T_k, so all in all it is
// wrong by less than 4.3 M 2^-64. A part of a span is taken only where that holds: in the disc of
// radius 17/8 about the middle, which holds the ellipse, powers of the distance from the middle say
// that no polynomial there moves far from its value in the middle. Other parts are halved.
#pragma once
#include <vector>

#include "bernstein.h"

namespace knotwave::curves {

/// What is integrated over one span, t in [0, 1], the bottom positive:
/// speed: |tops| / bottom^2, the length of a path; ratio: tops[0] / bottom.
struct Integrand {
  enum class Kind { speed, ratio };
  Kind kind = Kind::speed;
  std::vector<Bernstein> tops;
  Bernstein bottom;
};

/// A part of a span over which the error is proved, or that is too short to matter.
class QuadraturePart {
 public:
  /// Where it lies in the span, 0..1.
  double start = 0, width = 1;

  /// Integral from its start to this share of it, by t of the span.
  DoubleDouble integral(DoubleDouble share = 1.0) const;
  /// The integrand at this share.
  double value(double share) const;

 private:
  friend class QuadratureSearch;
  Integrand::Kind kind_ = Integrand::Kind::speed;
  double flat_ = 0;  ///< the mean of a part too short to matter, which has no tops
  std::vector<std::vector<DoubleDouble>> tops_;  ///< powers of 2 share - 1
  std::vector<DoubleDouble> bottom_;
};

/// Parts that cover the span, in order. What a part contributes is known to 2^-60 of its integral
/// (of the largest |top / bottom| times its width, for a ratio), or is below `negligible`, of which
/// half is taken.
std::vector<QuadraturePart> quadrature_parts(const Integrand& integrand, double negligible);

}  // namespace knotwave::curves
