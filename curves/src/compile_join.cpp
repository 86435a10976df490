// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "knotwave/curves/compile.h"

#include "compile_parts.h"
#include "grid_kernel.h"

namespace knotwave::curves {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The curve (R0, R1): control points (1, 0), (0, 1) and then (0, 0), with the section's weights.
Result<NurbsCurve> basis_curve(const NurbsCurve& section) {
  CurveSpec spec = section.spec();
  spec.dim = 2;
  spec.points.assign(at(section.point_count()) * 2, 0.0);
  spec.points[0] = 1.0;
  spec.points[3] = 1.0;
  return NurbsCurve::create(std::move(spec));
}

/// Join of a 1-D curve at u.
Result<JoinProgram> join_at(const NurbsCurve& curve, double u_join, CompileOptions options) {
  const auto section = sub_curve(curve, u_join, curve.u_max());
  if (!section) return section.error();
  const auto basis = basis_curve(*section);
  if (!basis) return basis.error();
  const HullRange hull = hull_over(curve, 0, options.controls);
  options.controls.clear();
  auto program = compile_parametric(*basis, options);
  if (!program) return program.error();

  const int p = section->degree();
  const auto knots = section->knots();
  const auto weights = section->weights();
  JoinProgram join;
  join.u_join = u_join;
  join.basis = std::move(*program);
  join.u_basis_end = knots[at(std::min(p + 2, section->point_count()))];
  join.p0 = section->points()[0];
  join.p1 = section->points()[1];
  join.slope_factor = p * (weights[1] / weights[0]) / (knots[at(p) + 1] - knots[1]);
  join.low = hull.low;
  join.high = hull.high;
  join.moves_p1 = p > 1;
  return join;
}

}  // namespace

JoinProgram::Deltas JoinProgram::join(double value0, double slope0) const KNOTWAVE_RT {
  return join_from(p0, slope_factor * (p1 - p0), value0, slope0);
}

JoinProgram::Deltas JoinProgram::join_from(double program_value, double program_slope,
                                           double value0, double slope0) const KNOTWAVE_RT {
  Deltas deltas = join_c0_from(program_value, value0);
  const double present = program_value + program_slope / slope_factor;
  const double wanted = (program_value + deltas.dp0) + slope0 / slope_factor;
  const double allowed = clamp_to_hull(wanted, low, high);
  deltas.limited = !moves_p1 || !(allowed == wanted);
  if (moves_p1 && wanted == wanted && present == present) deltas.dp1 = allowed - present;
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
  if (curve.degree() > kMaxPieceDegree) {
    return fail(ErrorCode::unsupported, "curve '" + curve.name() + "' has degree " +
                                            std::to_string(curve.degree()) +
                                            ", joins are for degree 1..7");
  }
  if (auto checked = check_controls(curve, options.controls); !checked) return checked.error();
  if (curve.dim() == 1) return join_at(curve, u_join, options);
  return fail(ErrorCode::unsupported, "2-D");
}

}  // namespace knotwave::curves
