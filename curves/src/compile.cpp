// SPDX-License-Identifier: MIT
#include "knotwave/curves/compile.h"

#include <string>

#include "compile_parts.h"

namespace knotwave::curves {
namespace {

/// Looks a span when the pieces are exact and only rounding is to be measured.
constexpr int kExactLooks = 5;

Result<void> check_options(const NurbsCurve& curve, const CompileOptions& options) {
  if (!(options.max_error > 0) || options.max_pieces < 1) {
    return fail(ErrorCode::value_out_of_range,
                "curve '" + curve.name() + "': max_error and max_pieces must be above 0");
  }
  if (auto widths = check_widths(curve); !widths) return widths;
  if (!options.controls.empty() && curve.degree() > kMaxPieceDegree) {
    return fail(ErrorCode::unsupported, "curve '" + curve.name() +
                                            "': controls need degree 1..7, this curve has degree " +
                                            std::to_string(curve.degree()));
  }
  return check_controls(curve, options.controls);
}

Result<CurveProgram> finish_exact(const NurbsCurve& curve, const CompileOptions& options) {
  auto parts = exact_parts(curve, options.controls);
  if (!parts) return parts.error();
  if (static_cast<int>(parts->pieces()) > options.max_pieces) {
    return fail(ErrorCode::error_bound_missed,
                "curve '" + curve.name() + "' has " + std::to_string(parts->pieces()) + " spans, " +
                    std::to_string(options.max_pieces) + " pieces are allowed");
  }
  CurveProgram program = ProgramBuilder::build(std::move(*parts));
  const auto error = measured_error(program, curve, options.controls, kExactLooks);
  if (!error) return error.error();
  if (!(*error <= options.max_error)) {
    return missed_bound(curve, *error, options.max_error,
                        "this is rounding; weights or points are too far apart");
  }
  ProgramBuilder::set_max_error(program, *error);
  return program;
}

}  // namespace

Result<CurveProgram> compile_parametric(const NurbsCurve& curve, const CompileOptions& options) {
  if (auto checked = check_options(curve, options); !checked) return checked.error();
  if (curve.degree() > kMaxPieceDegree) {
    return fail(ErrorCode::unsupported, "degree > 7");
  }
  return finish_exact(curve, options);
}

Result<CurveProgram> compile_polynomial(const NurbsCurve& curve, const CompileOptions& options) {
  if (curve.is_rational()) return fail(ErrorCode::unsupported, "rational");
  return compile_parametric(curve, options);
}

Result<CurveProgram> compile_function(const NurbsCurve& curve, const CompileOptions& options) {
  if (curve.dim() > 2) {
    return fail(ErrorCode::not_scalar, "curve '" + curve.name() + "' has " +
                                           std::to_string(curve.dim()) +
                                           " coordinates; a function has 1, or 2 with time first");
  }
  if (curve.dim() == 1) return compile_parametric(curve, options);
  return fail(ErrorCode::unsupported, "2-D");
}

}  // namespace knotwave::curves
