// SPDX-License-Identifier: MIT
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/curves/compile.h"

#include "compile_parts.h"
#include "grid_kernel.h"
#include "time_inversion.h"

namespace knotwave::curves {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// How much of a join's step a point takes part in: all of it if it is level with the first,
/// nothing at the hull's edges. A step that leaves the first point in the hull then leaves this one
/// in it.
double share(double point, double first, const HullRange& hull) {
  if (point == first) return 1;
  return point > first ? (hull.high - point) / (hull.high - first)
                       : (point - hull.low) / (first - hull.low);
}

/// Which points move with the first: none, or first..last by their share().
struct Followers {
  int first = 0, last = -1;
};
Followers followers_of(int degree, bool moves_p1) {
  return {moves_p1 ? 2 : 1, degree == 2 ? 1 : degree - 2};
}

/// The curve (B0, B1) of a 1-D section, (x, B0, B1) of a 2-D one, with the section's weights:
/// control points (1, 0), (0, 1), (0, 0), ... but (share(), 0) for those that follow the first.
Result<NurbsCurve> basis_curve(const NurbsCurve& section, const HullRange& hull,
                               const Followers& followers) {
  CurveSpec spec = section.spec();
  const int time = section.dim() - 1;  // coordinates before B0
  const auto value = [&](int i) { return section.points()[at(i * section.dim() + time)]; };
  spec.dim = time + 2;
  spec.points.assign(at(section.point_count() * spec.dim), 0.0);
  for (int i = 0; i < section.point_count(); ++i) {
    double* const point = &spec.points[at(i * spec.dim)];
    if (time == 1) point[0] = section.points()[at(i * 2)];
    const bool follows = i >= followers.first && i <= followers.last;
    if (follows) point[time] = share(value(i), value(0), hull);
    if (i < 2 && !follows) point[time + i] = 1;
  }
  return NurbsCurve::create(std::move(spec));
}

/// The part of a curve from a join on; in a 2-D one from the time of the join, exactly.
Result<NurbsCurve> section_from(const NurbsCurve& curve, double u_join) {
  if (curve.dim() == 1) return sub_curve(curve, u_join, curve.u_max());
  double first[2], last[2];
  curve.evaluate(curve.u_min(), first);
  curve.evaluate(curve.u_max(), last);
  if (!(u_join >= first[0] && u_join < last[0])) {
    return fail(ErrorCode::parameter_out_of_range,
                "curve '" + curve.name() + "': a join at x = " + base::number_text(u_join) +
                    " is not inside " + base::number_text(first[0]) + ".." +
                    base::number_text(last[0]));
  }
  auto section = sub_curve(curve, parameter_at_time(curve, u_join), curve.u_max());
  if (!section) return section;
  CurveSpec spec = section->spec();
  spec.points[0] = u_join;
  return NurbsCurve::create(std::move(spec));
}

/// What P1 - P0 is divided by for the slope at the start. Per unit of u: p w1 / w0 over the knot
/// difference. Per unit of time, over dx/du of the same kind.
double by_of_p1(const NurbsCurve& section) {
  if (section.dim() == 2) return section.points()[2] - section.points()[0];
  const int p = section.degree();
  return (section.knots()[at(p) + 1] - section.knots()[1]) /
         (p * (section.weights()[1] / section.weights()[0]));
}

double length_of(const NurbsCurve& section) {
  if (section.dim() == 1) return section.u_max() - section.u_min();
  return section.points()[at(2 * section.point_count() - 2)] - section.points()[0];
}

/// From here on both bases are 0: the start of the last pieces without any coefficient.
double end_of(const CurveProgram& basis) {
  int piece = basis.piece_count();
  const auto is_zero = [&](int i) {
    for (int c = 0; c < 2; ++c) {
      for (const double x : basis.coefficients(i, c)) {
        if (x != 0) return false;
      }
    }
    return true;
  };
  while (piece > 0 && is_zero(piece - 1)) --piece;
  return basis.breaks()[at(piece)];
}

}  // namespace

JoinProgram::Deltas JoinProgram::join(double value0, double slope0) const KNOTWAVE_RT {
  return join_from(p0, slope_factor * (p1 - p0), value0, slope0);
}

JoinProgram::Deltas JoinProgram::join_from(double program_value, double program_slope,
                                           double value0, double slope0) const KNOTWAVE_RT {
  Deltas deltas = join_c0_from(program_value, value0);
  deltas.limited = !moves_p1;
  if (!moves_p1) return deltas;
  const double present = program_value + program_slope / slope_factor;
  const double wanted = (program_value + deltas.dp0) + slope0 / slope_factor;
  const double allowed = clamp_to_hull(wanted, low, high);
  deltas.limited = !(allowed == wanted);
  if (wanted == wanted && present == present) deltas.dp1 = allowed - present;
  return deltas;
}

JoinProgram::Deltas JoinProgram::join_c0(double value0) const KNOTWAVE_RT {
  return join_c0_from(p0, value0);
}

JoinProgram::Deltas JoinProgram::join_c0_from(double program_value,
                                              double value0) const KNOTWAVE_RT {
  Deltas deltas;
  const double step = value0 - program_value;
  deltas.dp0 = std::abs(step) <= 2 * kMaxCoordinate ? step : 0.0;  // false for NaN
  return deltas;
}

Result<JoinProgram> compile_join(const NurbsCurve& curve, double u_join,
                                 const CompileOptions& options) {
  if (curve.dim() > 2) {
    return fail(ErrorCode::unsupported, "curve '" + curve.name() +
                                            "': joins are for 1 or 2 coordinates, not " +
                                            std::to_string(curve.dim()));
  }
  if (auto checked = check_controls(curve, options.controls); !checked) return checked.error();
  const bool timed = curve.dim() == 2;
  if (timed && !is_non_decreasing(curve)) return compile_function(curve, options).error();
  const auto section = section_from(curve, u_join);
  if (!section) return section.error();
  const HullRange hull = hull_over(curve, curve.dim() - 1, options.controls);
  // What a controller moves might leave the hull if it followed: then only two points move.
  const bool follow = options.controls.empty();
  const double by = by_of_p1(*section);
  const int p = section->degree();
  const bool is_vertical = p > 1 && !(by > 1e-12 * length_of(*section));
  const bool moves_p1 = p > (follow ? 2 : 1) && !is_vertical;
  const auto basis = basis_curve(
      *section, hull, follow && p > 1 && !is_vertical ? followers_of(p, moves_p1) : Followers());
  if (!basis) return basis.error();
  CompileOptions basis_options = options;
  basis_options.controls.clear();
  auto program =
      timed ? compile_timed(*basis, basis_options) : compile_parametric(*basis, basis_options);
  if (!program) return program.error();

  const auto points = section->points();
  JoinProgram join;
  join.u_join = u_join;
  join.basis = std::move(*program);
  join.u_basis_end = end_of(join.basis);
  join.p0 = points[timed ? 1 : 0];
  join.p1 = points[timed ? 3 : 1];
  join.moves_p1 = moves_p1;
  join.is_vertical = is_vertical;
  join.slope_factor = moves_p1 ? 1 / by : 0;
  join.low = hull.low;
  join.high = hull.high;
  return join;
}

}  // namespace knotwave::curves
