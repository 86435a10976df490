// SPDX-License-Identifier: MIT
// y at a time, of a curve (time, value) whose points are other at every sample. See
// knotwave/curves/moving_curve.h.
#pragma once
#include "knotwave/c/curve.h"

KW_BEGIN

typedef struct kw_moving_curve kw_moving_curve;

/// Takes degree (7 at most), knots, weights and jumps of a 2-D curve. [control]
KW_API kw_status kw_moving_curve_create(const kw_curve* curve, kw_moving_curve** out,
                                        kw_error** error);
KW_API void kw_moving_curve_free(kw_moving_curve* curve);
KW_API int32_t kw_moving_curve_degree(const kw_moving_curve* curve);
KW_API size_t kw_moving_curve_point_count(const kw_moving_curve* curve);

// [audio] No function below allocates, locks, blocks or calls the system.
/// y at `time` with the points (x, y), points_count = 2 * point_count; 0 if it is not.
KW_API double kw_moving_curve_at(const kw_moving_curve* curve, double time, const double* points,
                                 size_t points_count);
/// out[i] at times[i] with the points (rows[0][i], rows[1][i]), (rows[2][i], rows[3][i]), ...:
/// rows_count = 2 * point_count. What cannot be is silence and a status.
KW_API kw_status kw_moving_curve_render(const kw_moving_curve* curve, const double* times,
                                        size_t times_count, const double* const* rows,
                                        size_t rows_count, double* out, size_t out_count);

KW_END
