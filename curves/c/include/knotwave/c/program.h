// SPDX-License-Identifier: MIT
// Curves compiled to what the audio thread plays, and grids rendered from them. See
// knotwave/curves/compile.h and curve_program.h.
#pragma once
#include "knotwave/c/curve.h"

KW_BEGIN

#define KW_MAX_CONTROLS 8

typedef struct kw_program kw_program;

typedef int32_t kw_control_kind;
enum { KW_CONTROL_WEIGHT = 0, KW_CONTROL_COORDINATE = 1, KW_CONTROL_KNOT = 2 };

/// Something that may be moved while the curve plays, with its range in absolute values.
typedef struct kw_control_range {
  kw_control_kind kind;
  int32_t point;       ///< from 0, as the spec lists them; KW_CONTROL_KNOT: of the knot
  int32_t coordinate;  ///< for KW_CONTROL_COORDINATE
  int32_t reserved;    ///< 0
  double low;
  double high;
} kw_control_range;

/// kw_compile_options options = KW_COMPILE_OPTIONS_INIT; then set what differs.
typedef struct kw_compile_options {
  size_t struct_size;  ///< set by KW_COMPILE_OPTIONS_INIT
  double max_error;    ///< largest |program - curve| asked for, in output units
  int32_t max_pieces;  ///< more is an error
  const kw_control_range* controls;
  size_t controls_count;
} kw_compile_options;
#define KW_COMPILE_OPTIONS_INIT \
  { sizeof(kw_compile_options), 1e-7, 4096, NULL, 0 }

// [control] options may be NULL.
/// A curve as a function: of u (dim 1), or of its first coordinate, the time (dim 2).
KW_API kw_status kw_compile_function(const kw_curve* curve, const kw_compile_options* options,
                                     kw_program** out, kw_error** error);
/// Every coordinate as a function of u.
KW_API kw_status kw_compile_parametric(const kw_curve* curve, const kw_compile_options* options,
                                       kw_program** out, kw_error** error);
/// The same, rational spans too as polynomial pieces within max_error.
KW_API kw_status kw_compile_polynomial(const kw_curve* curve, const kw_compile_options* options,
                                       kw_program** out, kw_error** error);
KW_API kw_status kw_program_copy(const kw_program* program, kw_program** out, kw_error** error);
KW_API void kw_program_free(kw_program* program);

// What a program is. [any] NaN or NULL for a control, coordinate or piece that is not there.
KW_API int32_t kw_program_dim(const kw_program* program);
KW_API bool kw_program_is_rational(const kw_program* program);
KW_API bool kw_program_is_periodic(const kw_program* program);
KW_API int32_t kw_program_piece_count(const kw_program* program);
KW_API int32_t kw_program_piece_degree(const kw_program* program);
KW_API double kw_program_u_min(const kw_program* program);
KW_API double kw_program_u_max(const kw_program* program);
/// |program - curve| is nowhere above this: proved, with controls measured (curve_program.h).
KW_API double kw_program_max_error(const kw_program* program);
/// The range that a coordinate never leaves.
KW_API double kw_program_low(const kw_program* program, int32_t coordinate);
KW_API double kw_program_high(const kw_program* program, int32_t coordinate);
KW_API int32_t kw_program_control_count(const kw_program* program);
KW_API double kw_program_control_rest(const kw_program* program, int32_t control);
KW_API double kw_program_control_low(const kw_program* program, int32_t control);
KW_API double kw_program_control_high(const kw_program* program, int32_t control);
/// Where pieces meet, [piece_count + 1]. Borrowed.
KW_API const double* kw_program_breaks(const kw_program* program, size_t* count);
/// Powers of t = (u - start of the piece) / its width, lowest first, [piece_degree + 1]. Borrowed.
/// Coordinate `dim` of a rational program is the denominator.
KW_API const double* kw_program_coefficients(const kw_program* program, int32_t piece,
                                             int32_t coordinate, size_t* count);

// Playing. [audio] No function below allocates, locks, blocks or calls the system, and each has an
// output for every input: NaN counts as u_min, a coordinate that is not there gives 0 everywhere
// and KW_DIMENSION_MISMATCH. Any split of a block into smaller ones gives the same bits.

/// Value and derivative at u. controls[control_count], or none for rest values.
KW_API double kw_program_at(const kw_program* program, double u, int32_t coordinate,
                            const double* controls, size_t controls_count);
KW_API double kw_program_slope_at(const kw_program* program, double u, int32_t coordinate,
                                  const double* controls, size_t controls_count);

/// A block of an endless grid: out[i] is the value at origin + (first + i) * step. `cursor` is a
/// hint that makes the next block quicker, 0 at first, one for each voice and program; any value
/// gives the same samples, NULL too.
KW_API kw_status kw_program_render(const kw_program* program, double origin, double step,
                                   int64_t first, int32_t coordinate, double* out, size_t out_count,
                                   int32_t* cursor);
KW_API kw_status kw_program_render_float(const kw_program* program, double origin, double step,
                                         int64_t first, int32_t coordinate, float* out,
                                         size_t out_count, int32_t* cursor);
/// out[i] at u[i], any places in any order.
KW_API kw_status kw_program_render_at(const kw_program* program, const double* u, size_t u_count,
                                      int32_t coordinate, double* out, size_t out_count,
                                      int32_t* cursor);
/// The same with controls that move every sample: controls[k][i].
KW_API kw_status kw_program_render_controlled(const kw_program* program, const double* u,
                                              size_t u_count, const double* const* controls,
                                              size_t controls_count, int32_t coordinate,
                                              double* out, size_t out_count, int32_t* cursor);
/// Nodes first, first + 1, ... of the grid of n steps from u1 to u2 (glMapGrid), whose node n is
/// exactly u2. First coordinate.
KW_API kw_status kw_program_evaluate_grid(const kw_program* program, double u1, double u2,
                                          int64_t n, int64_t first, float* out, size_t out_count);

KW_END
