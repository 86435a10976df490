// SPDX-License-Identifier: MIT
// Curves compiled and played from C.
#include <algorithm>
#include <array>
#include <limits>

#include "knotwave/curves/compile.h"

#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;
using curves::CompileOptions;
using curves::ControlRange;
using curves::CurveProgram;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr ControlRange::Kind kKinds[] = {ControlRange::Kind::weight, ControlRange::Kind::coordinate,
                                         ControlRange::Kind::knot};
static_assert(std::size(kKinds) == KW_CONTROL_KNOT + 1);

}  // namespace

Result<CompileOptions> c::compile_options_of(const kw_compile_options* options) {
  CompileOptions made;
  if (options == nullptr) return made;
  if (options->struct_size != sizeof(kw_compile_options)) {
    return fail(ErrorCode::unsupported_version, "begin the options with KW_COMPILE_OPTIONS_INIT");
  }
  if (options->controls_count > size_t{curves::kMaxControls}) {
    return fail(ErrorCode::value_out_of_range,
                std::to_string(options->controls_count) + " controls, at most " +
                    std::to_string(curves::kMaxControls) + " are allowed");
  }
  made.max_error = options->max_error;
  made.max_pieces = options->max_pieces;
  for (size_t i = 0; i < options->controls_count; ++i) {
    const kw_control_range& from = options->controls[i];
    if (from.kind < 0 || from.kind > KW_CONTROL_KNOT) {
      return unknown_choice("the kind of a control", from.kind, std::size(kKinds));
    }
    if (from.reserved != 0) {
      return fail(ErrorCode::value_out_of_range, "control " + std::to_string(i) + ": reserved is " +
                                                     std::to_string(from.reserved) + ", not 0");
    }
    made.controls.push_back({kKinds[from.kind], from.point, from.coordinate, from.low, from.high});
  }
  return made;
}

namespace {

using Compiler = Result<CurveProgram> (*)(const curves::NurbsCurve&, const CompileOptions&);

kw_status compile_with(Compiler compiler, const kw_curve* curve, const kw_compile_options* options,
                       kw_program** out, kw_error** error) {
  if (out != nullptr) *out = nullptr;
  return run({{"curve", curve}, {"out", out}, needed_controls(options)}, error, [&]() -> kw_status {
    const Result<CompileOptions> asked = compile_options_of(options);
    if (!asked) return report(error, asked.error());
    return give(compiler(curve->curve, *asked), error,
                [&](CurveProgram&& program) { *out = new kw_program{std::move(program)}; });
  });
}

bool has_coordinate(const kw_program* program, int32_t coordinate) {
  return program != nullptr && coordinate >= 0 && coordinate < program->program.dim();
}

/// Before a block is rendered; a coordinate that is not there is silence.
template <class Sample>
kw_status check(const kw_program* program, int32_t coordinate, Sample* out, size_t out_count) {
  if (out == nullptr && out_count > 0) return KW_NULL_ARGUMENT;
  if (has_coordinate(program, coordinate)) return KW_OK;
  std::fill_n(out, out_count, Sample(0));
  return program == nullptr ? KW_NULL_ARGUMENT : KW_DIMENSION_MISMATCH;
}

template <class Render>
kw_status with_cursor(int32_t* cursor, Render&& render) {
  curves::CurveCursor here{cursor == nullptr ? 0 : *cursor};
  render(here);
  if (cursor != nullptr) *cursor = here.piece;
  return KW_OK;
}

template <class Sample>
kw_status render_run(const kw_program* program, const curves::GridRun& grid, int32_t coordinate,
                     Sample* out, size_t out_count, int32_t* cursor) {
  const kw_status good = check(program, coordinate, out, out_count);
  if (good != KW_OK) return good;
  return with_cursor(cursor, [&](curves::CurveCursor& here) {
    program->program.render(grid, std::span<Sample>(out, out_count), here, coordinate);
  });
}

/// The controls a program has room for: those given, or none.
std::span<const double> controls_of(const kw_program& program, const double* controls,
                                    size_t count) {
  if (controls == nullptr || count != index_of(program.program.control_count())) return {};
  return {controls, count};
}

}  // namespace

kw_status kw_compile_function(const kw_curve* curve, const kw_compile_options* options,
                              kw_program** out, kw_error** error) {
  return compile_with(curves::compile_function, curve, options, out, error);
}
kw_status kw_compile_parametric(const kw_curve* curve, const kw_compile_options* options,
                                kw_program** out, kw_error** error) {
  return compile_with(curves::compile_parametric, curve, options, out, error);
}
kw_status kw_compile_polynomial(const kw_curve* curve, const kw_compile_options* options,
                                kw_program** out, kw_error** error) {
  return compile_with(curves::compile_polynomial, curve, options, out, error);
}
kw_status kw_program_copy(const kw_program* program, kw_program** out, kw_error** error) {
  if (out != nullptr) *out = nullptr;
  return run({{"program", program}, {"out", out}}, error, [&]() -> kw_status {
    *out = new kw_program{program->program};
    return KW_OK;
  });
}
void kw_program_free(kw_program* program) { delete program; }

int32_t kw_program_dim(const kw_program* program) { return program ? program->program.dim() : 0; }
bool kw_program_is_rational(const kw_program* program) {
  return program && program->program.is_rational();
}
bool kw_program_is_periodic(const kw_program* program) {
  return program && program->program.is_periodic();
}
int32_t kw_program_piece_count(const kw_program* program) {
  return program ? program->program.piece_count() : 0;
}
int32_t kw_program_piece_degree(const kw_program* program) {
  return program ? program->program.piece_degree() : 0;
}
double kw_program_u_min(const kw_program* program) {
  return program ? program->program.u_min() : 0;
}
double kw_program_u_max(const kw_program* program) {
  return program ? program->program.u_max() : 0;
}
double kw_program_max_error(const kw_program* program) {
  return program ? program->program.max_error() : 0;
}
double kw_program_low(const kw_program* program, int32_t coordinate) {
  return has_coordinate(program, coordinate) ? program->program.low(coordinate) : kNone;
}
double kw_program_high(const kw_program* program, int32_t coordinate) {
  return has_coordinate(program, coordinate) ? program->program.high(coordinate) : kNone;
}
int32_t kw_program_control_count(const kw_program* program) {
  return program ? program->program.control_count() : 0;
}
double kw_program_control_rest(const kw_program* program, int32_t control) {
  const bool there = control >= 0 && control < kw_program_control_count(program);
  return there ? program->program.control_rest(control) : kNone;
}
double kw_program_control_low(const kw_program* program, int32_t control) {
  const bool there = control >= 0 && control < kw_program_control_count(program);
  return there ? program->program.control_low(control) : kNone;
}
double kw_program_control_high(const kw_program* program, int32_t control) {
  const bool there = control >= 0 && control < kw_program_control_count(program);
  return there ? program->program.control_high(control) : kNone;
}
const double* kw_program_breaks(const kw_program* program, size_t* count) {
  return program ? lent(program->program.breaks(), count) : nothing_lent(count);
}
const double* kw_program_coefficients(const kw_program* program, int32_t piece, int32_t coordinate,
                                      size_t* count) {
  if (piece < 0 || piece >= kw_program_piece_count(program)) return nothing_lent(count);
  const int32_t rows = program->program.dim() + (program->program.is_rational() ? 1 : 0);
  if (coordinate < 0 || coordinate >= rows) return nothing_lent(count);
  return lent(program->program.coefficients(piece, coordinate), count);
}

double kw_program_at(const kw_program* program, double u, int32_t coordinate,
                     const double* controls, size_t controls_count) {
  if (!has_coordinate(program, coordinate)) return 0;
  return program->program.at_u(u, coordinate, controls_of(*program, controls, controls_count));
}
double kw_program_slope_at(const kw_program* program, double u, int32_t coordinate,
                           const double* controls, size_t controls_count) {
  if (!has_coordinate(program, coordinate)) return 0;
  return program->program.slope_at_u(u, coordinate,
                                     controls_of(*program, controls, controls_count));
}

kw_status kw_program_render(const kw_program* program, double origin, double step, int64_t first,
                            int32_t coordinate, double* out, size_t out_count, int32_t* cursor) {
  return render_run(program, {origin, step, first}, coordinate, out, out_count, cursor);
}
kw_status kw_program_render_float(const kw_program* program, double origin, double step,
                                  int64_t first, int32_t coordinate, float* out, size_t out_count,
                                  int32_t* cursor) {
  return render_run(program, {origin, step, first}, coordinate, out, out_count, cursor);
}

kw_status kw_program_render_at(const kw_program* program, const double* u, size_t u_count,
                               int32_t coordinate, double* out, size_t out_count, int32_t* cursor) {
  return kw_program_render_controlled(program, u, u_count, nullptr, 0, coordinate, out, out_count,
                                      cursor);
}

kw_status kw_program_render_controlled(const kw_program* program, const double* u, size_t u_count,
                                       const double* const* controls, size_t controls_count,
                                       int32_t coordinate, double* out, size_t out_count,
                                       int32_t* cursor) {
  if (u_count != out_count) return KW_DIMENSION_MISMATCH;
  const kw_status good = check(program, coordinate, out, out_count);
  if (good != KW_OK) return good;
  const bool has_null =
      controls_count > 0 && (controls == nullptr || std::any_of(controls, controls + controls_count,
                                                                [](auto one) { return !one; }));
  if ((u == nullptr && u_count > 0) || has_null) {
    std::fill_n(out, out_count, 0.0);
    return KW_NULL_ARGUMENT;
  }
  if (controls_count != 0 && controls_count != index_of(program->program.control_count())) {
    std::fill_n(out, out_count, 0.0);
    return KW_DIMENSION_MISMATCH;
  }
  return with_cursor(cursor, [&](curves::CurveCursor& here) {
    program->program.render({u, u_count}, {controls, controls_count}, {out, out_count}, here,
                            coordinate);
  });
}

kw_status kw_program_evaluate_grid(const kw_program* program, double u1, double u2, int64_t n,
                                   int64_t first, float* out, size_t out_count) {
  const kw_status good = check(program, 0, out, out_count);
  if (good != KW_OK) return good;
  if (n < 1) {
    std::fill_n(out, out_count, 0.0F);
    return KW_VALUE_OUT_OF_RANGE;
  }
  program->program.evaluate_grid({u1, u2, n}, first, {out, out_count});
  return KW_OK;
}
