// SPDX-License-Identifier: MIT
#include "knotwave/curves/compile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "compile_parts.h"
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

/// A proved bound this small against the curve's values is taken without measuring how far below
/// it the error is. Up to degree 5 it is, but where weights lie far apart.
constexpr double kNegligible = 0x1p-40;

/// Infinity where nothing is proved: pieces that were fitted, one weight for all points, controls.
double proved_bound(const NurbsCurve& curve, const ProgramParts& parts) {
  const bool is_exact = parts.degree == curve.degree() && parts.max_error == 0 &&
                        parts.rational == curve.is_rational();
  const bool is_scaled = !parts.rational && curve.weights().front() != 1;
  if (!is_exact || is_scaled || !parts.control_rest.empty()) {
    return std::numeric_limits<double>::infinity();
  }
  return rounding_bound(parts);
}

double negligible(const ProgramParts& parts) {
  double largest = 0;
  for (std::size_t c = 0; c < parts.low.size(); ++c) {
    largest = std::max({largest, std::abs(parts.low[c]), std::abs(parts.high[c])});
  }
  return kNegligible * largest;
}

/// The program of finished pieces, its error against the curve measured once more by
/// NurbsCurve::evaluate, which knows nothing of pieces, where it is not proved.
Result<CurveProgram> checked_program(const NurbsCurve& curve, ProgramParts parts,
                                     const CompileOptions& options) {
  if (static_cast<int>(parts.pieces()) > options.max_pieces) {
    return fail(ErrorCode::error_bound_missed,
                "curve '" + curve.name() + "' has " + std::to_string(parts.pieces()) + " spans, " +
                    std::to_string(options.max_pieces) + " pieces are allowed");
  }
  const double fit_error = parts.max_error;
  const double bound = proved_bound(curve, parts);
  const bool is_proved = bound <= negligible(parts);
  CurveProgram program = ProgramBuilder::build(std::move(parts));
  double error = bound;
  if (!is_proved) {
    const auto measured = measured_error(program, curve, options.controls);
    if (!measured) return measured.error();
    error = bound < *measured ? bound : *measured;  // NaN stays
  }
  if (!(error <= options.max_error)) {
    return missed_bound(curve, error, options.max_error,
                        "this is rounding; weights or points are too far apart");
  }
  ProgramBuilder::set_max_error(program, std::max(error, fit_error));
  return program;
}

Result<CurveProgram> fitted_program(const NurbsCurve& curve, const CompileOptions& options,
                                    Meeting meeting) {
  auto parts = fitted_parts(curve, options, meeting);
  if (!parts) return parts.error();
  return checked_program(curve, std::move(*parts), options);
}

Result<CurveProgram> exact_program(const NurbsCurve& curve, const CompileOptions& options) {
  return checked_program(curve, exact_parts(curve, options.controls), options);
}

}  // namespace

Result<CurveProgram> compile_parametric(const NurbsCurve& curve, const CompileOptions& options) {
  if (auto checked = check_options(curve, options); !checked) return checked.error();
  if (curve.degree() <= kMaxPieceDegree) {
    auto exact = exact_program(curve, options);
    if (exact || !options.controls.empty()) return exact;
    const ProgramParts parts = exact_parts(curve, {});
    if (proved_bound(curve, parts) <= negligible(parts)) return exact;
    // Weights a million to one apart can round away too much; shorter pieces then still meet it.
    auto shorter = fitted_program(curve, options, Meeting::value);
    return shorter ? std::move(shorter) : std::move(exact);
  }
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
