// SPDX-License-Identifier: MIT
// A program in float32: several times as fast, with a proved error of its own. See
// knotwave/curves/fast_program.h.
#pragma once
#include "knotwave/c/program.h"

KW_BEGIN

typedef struct kw_fast_program kw_fast_program;

/// Pieces whose float32 error would be above max_error are played in double; INFINITY: none.
/// [control]
KW_API kw_status kw_fast_program_create(const kw_program* program, double max_error,
                                        kw_fast_program** out, kw_error** error);
KW_API void kw_fast_program_free(kw_fast_program* program);

/// No sample is farther from the curve, in output units; NaN for a coordinate that is not there.
/// [any]
KW_API double kw_fast_program_max_error(const kw_fast_program* program, int32_t coordinate);
/// How many pieces of a coordinate are played in float32. [any]
KW_API int32_t kw_fast_program_fast_piece_count(const kw_fast_program* program, int32_t coordinate);

/// As kw_program_render_float. [audio]
KW_API kw_status kw_fast_program_render(const kw_fast_program* program, double origin, double step,
                                        int64_t first, int32_t coordinate, float* out,
                                        size_t out_count, int32_t* cursor);

KW_END
