// SPDX-License-Identifier: MIT
// A part of the (u, v) plane inside closed curves: key and velocity zones, loop regions, a trimmed
// surface. [control] The rules are those of gluBeginTrim (OpenGL GLU 1.3, trimming): what lies to
// the left of a loop is kept, and nested loops alternate.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

/// Curves end to end, the last one ending where the first begins.
using TrimLoop = std::vector<NurbsCurve>;

struct Interval {
  double low = 0;
  double high = 0;

  friend bool operator==(const Interval&, const Interval&) = default;
};

class TrimRegion {
 public:
  /// 2-D curves, x along u and y along v. Ends of a loop meet within `tolerance` in each coordinate
  /// and are joined: each curve then begins where the one before it ends. Counter-clockwise loops
  /// keep their inside, clockwise ones the outside; no loop at all keeps everything. That loops
  /// neither cross nor touch, themselves included, is proved by their hulls; ones nearer than 2^-40
  /// of their size count as touching, and so do ones that 2^18 pairs of hulls, 64 more for each
  /// part, do not tell apart. Errors: dimension_mismatch, not_closed (a gap or a jump: the
  /// message has the places), malformed (loops cross or touch; what one keeps another does not; a
  /// loop encloses nothing), value_out_of_range (tolerance < 0).
  static Result<TrimRegion> create(std::span<const TrimLoop> loops, double tolerance = 1e-9);

  /// Whether (u, v) is kept. Borders are, within 4 ulp of the largest coordinate of a loop; NaN is
  /// not. [any] No allocation; a root is sought on the pieces whose box is met.
  bool contains(double u, double v) const noexcept;

  /// What is kept at this v (or u), borders included, in order and apart from each other. A point
  /// where the line only touches the region is an interval without length. Unbounded ends are
  /// infinite. NaN: none.
  std::vector<Interval> intervals_at_v(double v) const;
  std::vector<Interval> intervals_at_u(double u) const;

  /// As joined.
  const std::vector<TrimLoop>& loops() const noexcept { return loops_; }
  /// Whether what lies beyond all loops is kept.
  bool is_unbounded() const noexcept { return unbounded_; }

 private:
  struct Borders;

  TrimRegion() = default;
  std::vector<TrimLoop> loops_;
  bool unbounded_ = true;
  std::shared_ptr<const Borders> borders_;  ///< copies share them: they never change
};

/// The rectangle [u_low, u_high] x [v_low, v_high] as a loop that keeps its inside: one zone.
/// Errors: empty_domain, not_finite, coordinate_out_of_range.
Result<TrimLoop> rectangle_loop(double u_low, double u_high, double v_low, double v_high);

}  // namespace knotwave::curves
