// SPDX-License-Identifier: MIT
#include "knotwave/curves/compile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "compile_parts.h"
#include "piece_rounding.h"
#include "time_inversion.h"

namespace knotwave::curves {
namespace {

Result<void> check_options(const NurbsCurve& curve, const CompileOptions& options) {
  if (!(options.max_error > 0) || options.max_pieces < 1) {
    return fail(ErrorCode::value_out_of_range,
                "curve '" + curve.name() + "': max_error and max_pieces must be above 0");
  }
  return check_controls(curve, options.controls);
}

Error no_controls(const NurbsCurve& curve, const std::string& why) {
  return fail(ErrorCode::unsupported, "curve '" + curve.name() + "': no controls " + why);
}

/// A bound this small against the curve's values is taken without a look for a smaller one. Up to
/// degree 5 it is, but where weights lie far apart.
constexpr double kNegligible = 0x1p-40;

double negligible(const ProgramParts& parts) {
  double largest = 0;
  for (std::size_t c = 0; c < parts.low.size(); ++c) {
    largest = std::max({largest, std::abs(parts.low[c]), std::abs(parts.high[c])});
  }
  return kNegligible * largest;
}

Error missed_by_rounding(const NurbsCurve& curve, double error, double asked) {
  return missed_bound(curve, error, asked, "this is rounding; weights or points are too far apart");
}

/// With controls: measured at rest and at the corners of their ranges by NurbsCurve::evaluate,
/// which knows nothing of pieces.
Result<CurveProgram> measured_program(const NurbsCurve& curve, ProgramParts parts,
                                      const CompileOptions& options) {
  CurveProgram program = ProgramBuilder::build(std::move(parts));
  const auto error = measured_error(program, curve, options.controls);
  if (!error) return error.error();
  if (!(*error <= options.max_error)) {
    return missed_by_rounding(curve, *error, options.max_error);
  }
  ProgramBuilder::set_max_error(program, *error);
  return program;
}

/// The most that any piece rounds away.
double rounding_of_all(const ProgramParts& parts, double asked) {
  double worst = 0;
  for (std::size_t i = 0; i < parts.pieces() && worst <= asked; ++i) {
    worst = std::max(worst, piece_rounding(parts, i, asked));
  }
  return worst;
}

/// The spans as they are, but cut where they would round away more than asked: proved.
Result<CurveProgram> exact_program(const NurbsCurve& curve, const CompileOptions& options) {
  ProgramParts parts = exact_parts(curve, options.controls);
  if (static_cast<int>(parts.pieces()) > options.max_pieces) {
    return fail(ErrorCode::error_bound_missed,
                "curve '" + curve.name() + "' has " + std::to_string(parts.pieces()) + " spans, " +
                    std::to_string(options.max_pieces) + " pieces are allowed");
  }
  if (!options.controls.empty()) return measured_program(curve, std::move(parts), options);
  parts.max_error = rounding_bound(parts);
  if (!(parts.max_error <= negligible(parts))) {
    parts.max_error = rounding_of_all(parts, options.max_error);
  }
  if (!(parts.max_error <= options.max_error)) {
    const double all = rounding_of_all(parts, std::numeric_limits<double>::infinity());
    parts.max_error = 0;
    if (!cut_to_rounding(curve, options, parts)) {
      return missed_by_rounding(curve, all, options.max_error);
    }
  }
  return ProgramBuilder::build(std::move(parts));
}

Result<CurveProgram> fitted_program(const NurbsCurve& curve, const CompileOptions& options,
                                    Meeting meeting) {
  auto parts = fitted_parts(curve, options, meeting);
  if (!parts) return parts.error();
  return ProgramBuilder::build(std::move(*parts));
}

}  // namespace

Result<CurveProgram> compile_parametric(const NurbsCurve& curve, const CompileOptions& options) {
  if (auto checked = check_options(curve, options); !checked) return checked.error();
  if (curve.degree() <= kMaxPieceDegree) return exact_program(curve, options);
  if (options.controls.empty()) return fitted_program(curve, options, Meeting::slope);
  return no_controls(curve, "above degree " + std::to_string(kMaxPieceDegree) +
                                ", this curve has degree " + std::to_string(curve.degree()));
}

Result<CurveProgram> compile_polynomial(const NurbsCurve& curve, const CompileOptions& options) {
  if (auto checked = check_options(curve, options); !checked) return checked.error();
  const bool moves_weight =
      std::any_of(options.controls.begin(), options.controls.end(),
                  [](const ControlRange& c) { return c.kind == ControlRange::Kind::weight; });
  if (moves_knots(options.controls)) return no_controls(curve, "on knots in the polynomial form");
  if (!curve.is_rational() && curve.degree() <= kMaxPieceDegree && !moves_weight) {
    return exact_program(curve, options);
  }
  if (options.controls.empty()) return fitted_program(curve, options, Meeting::value);
  return no_controls(curve, "where weights or a degree above 7 are made polynomial");
}

Result<CurveProgram> compile_function(const NurbsCurve& curve, const CompileOptions& options) {
  if (curve.dim() > 2) {
    return fail(ErrorCode::not_scalar, "curve '" + curve.name() + "' has " +
                                           std::to_string(curve.dim()) +
                                           " coordinates; a function has 1, or 2 with time first");
  }
  if (curve.dim() == 1) return compile_parametric(curve, options);
  if (auto checked = check_options(curve, options); !checked) return checked.error();
  if (!options.controls.empty()) return no_controls(curve, "on a curve with a time coordinate");
  return compile_timed(curve, options);
}

}  // namespace knotwave::curves
