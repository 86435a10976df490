// SPDX-License-Identifier: MIT
// Clamped curves laid end to end into one. Private to curves. [control]
#pragma once
#include <string>
#include <vector>

#include "knotwave/curves/algorithms.h"

#include "homogeneous.h"

namespace knotwave::curves {

/// A clamped curve as it is put together.
struct CurvePart {
  std::vector<double> knots;             ///< [n+p+1], each end p + 1 times
  std::vector<HomogeneousPoint> points;  ///< [n]
  std::vector<double> jumps;

  CurvePart() = default;
  explicit CurvePart(const NurbsCurve& clamped);
  explicit CurvePart(const BezierSegment& segment);
};

class CurveChain {
 public:
  CurveChain(int degree, int dim) : degree_(degree), dim_(dim) {}

  /// `next` begins where the chain ends, and has its degree and dim. Ends no farther apart than
  /// `tolerance` in any coordinate, or than 4 ulp of max|P| of both (what edits round), become the
  /// point of the left one, with a knot of multiplicity p; others a declared jump. At a joined end
  /// the weights of `next` are scaled so that both agree.
  void append(const CurvePart& next, double tolerance);

  /// Errors: those of NurbsCurve::create() and weight_out_of_range.
  Result<NurbsCurve> finish(const std::string& name) const;

 private:
  bool ends_meet(const CurvePart& next, double tolerance) const;

  int degree_;
  int dim_;
  CurvePart whole_;
  std::size_t last_part_ = 0;  ///< index of its first point
};

}  // namespace knotwave::curves
