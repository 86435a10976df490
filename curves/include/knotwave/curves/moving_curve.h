// SPDX-License-Identifier: MIT
// Time inversion while the control points move: y at a time, of a 2-D curve (time, value) whose
// points are other at every sample. compile_function() bakes the inversion of a curve that rests;
// this one halves, always as often, and needs no table, no memory and no sample before it.
#pragma once
#include <span>
#include <vector>

#include "knotwave/base/rt.h"
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

inline constexpr int kMaxMovingDegree = 7;

struct MovingBlock;  // src/moving_kernel.h

/// Degree, knots and weights of a curve in time; its points are given with each sample.
///
/// Method: of x(t) - time in Bernstein form, N halvings by de Casteljau keep the half in which the
/// sign changes, the chord over the last one gives t, and y is taken there. Nothing depends on
/// slopes, so vertical tangents cost and err no more than others.
/// Error: the y returned is at most 2^-24 R off the curve's value at a time within 2^-50 X of
/// the one asked for, plus 2^-50 Y of rounding. R is the range of the y of the points at that
/// sample, X and Y the largest |x| (the time counts too) and |y|. N = halvings() follows from the
/// degree and the weights: without weights 26 up to degree 3, 27 to 6, 28 for 7.
/// What x has to do: never go back. regularize_handles() says how far handles may reach, points in
/// rising x always do; where x goes back all the same, y is that of one of the times' places, or of
/// an end of a span.
class MovingCurve {
 public:
  /// [control] The points of `curve` are left behind, knots, weights and jumps count. Errors:
  /// dimension_mismatch (not 2 coordinates), degree_out_of_range (above kMaxMovingDegree),
  /// unsupported (periodic: sub_curve() cuts it open), weight_out_of_range (so far apart within a
  /// span that more than 50 halvings were needed).
  static Result<MovingCurve> create(const NurbsCurve& curve);

  int degree() const KNOTWAVE_RT { return degree_; }
  int point_count() const KNOTWAVE_RT { return point_count_; }
  int halvings() const KNOTWAVE_RT { return halvings_; }

  /// y at `time` with the points (x, y) [2 * point_count]. [audio] Times before the first x give
  /// the first y of the curve, those after the last x its last one; where time stands still, the y
  /// after that counts. Never outside the y of the span's points. NaN counts as the start in times
  /// and as 0 in points; all numbers are kept within kMaxCoordinate, those below 2^-800 count as 0.
  double at(double time, std::span<const double> points) const KNOTWAVE_RT;

  /// out[i] = at(times[i], {points[0][i], points[1][i], ...}) to the bit: points [2 * point_count],
  /// x and y of each point by turns, is a row of samples each. [audio] Cost: N (p + 1)^2 sums and
  /// selections a sample, in vectors; spans add their search.
  void render(std::span<const double> times, std::span<const double* const> points,
              std::span<double> out) const KNOTWAVE_RT;

 private:
  template <class Number>
  int span_at(double time, const Number& number) const KNOTWAVE_RT;
  template <class Number>
  void fill(MovingBlock& block, std::size_t column, double time,
            const Number& number) const KNOTWAVE_RT;

  int degree_ = 1;
  int point_count_ = 2;
  int halvings_ = 26;
  std::vector<int> first_points_;  ///< of each span
  /// What each weighted point has in each Bézier point: [(span * (p+1) + j) * (p+1) + i]
  std::vector<double> shares_;
  std::vector<double> weights_;  ///< of the Bézier points, [span * (p+1) + j]
};

}  // namespace knotwave::curves
