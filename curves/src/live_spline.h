// SPDX-License-Identifier: MIT
// A curve played from its points and knots themselves, because knots move: de Boor's algorithm at
// every sample. Private to curves.
#pragma once
#include <span>
#include <vector>

#include "knotwave/curves/compile.h"

namespace knotwave::curves {

/// Of degree <= kMaxPieceDegree, with controls that check_controls() let pass: so a moved knot
/// stays between the same two knots, and the span of u is the one at rest or a neighbour of it.
class LiveSpline {
 public:
  LiveSpline(const NurbsCurve& curve, const std::vector<ControlRange>& controls);  ///< [control]

  struct Jet {
    double value = 0;
    double slope = 0;
  };
  /// One coordinate at u in [u_min, u_max], with control k moved by moves[k] from rest. [audio]
  /// Cost: the search for the span, and p (p + 1) / 2 divisions and blends.
  Jet at(double u, int coordinate, std::span<const double> moves) const KNOTWAVE_RT;

 private:
  /// A number that a control moves; a periodic curve has some of them twice.
  struct Moved {
    ControlRange::Kind kind = ControlRange::Kind::weight;
    int index = 0;
    int coordinate = 0;
    std::size_t control = 0;
  };
  double knot(int index, std::span<const double> moves) const KNOTWAVE_RT;
  int span_at(double u, std::span<const double> moves) const KNOTWAVE_RT;

  int degree_ = 1;
  int dim_ = 1;
  bool rational_ = false;
  std::vector<double> knots_;    ///< [n+p+1], as NurbsCurve::knots()
  std::vector<double> points_;   ///< [n*dim], without weights
  std::vector<double> weights_;  ///< [n]
  std::vector<Moved> moved_;
};

}  // namespace knotwave::curves
