// SPDX-License-Identifier: MIT
// Curves as Bézier segments, and back. See knotwave/curves/bezier.h. [control]
#pragma once
#include "knotwave/c/curve.h"

KW_BEGIN

/// Segments of one degree that follow each other; segment i is over [ends[i], ends[i+1]].
typedef struct kw_bezier kw_bezier;

/// One segment a span of positive length.
KW_API kw_status kw_curve_to_bezier(const kw_curve* curve, kw_bezier** out, kw_error** error);
KW_API void kw_bezier_free(kw_bezier* bezier);

// [any] Arrays are borrowed.
KW_API size_t kw_bezier_segment_count(const kw_bezier* bezier);
KW_API int32_t kw_bezier_degree(const kw_bezier* bezier);
KW_API int32_t kw_bezier_dim(const kw_bezier* bezier);
KW_API const double* kw_bezier_ends(const kw_bezier* bezier, size_t* count);  ///< [segments + 1]
/// [segments*(degree+1)*dim], not pre-weighted.
KW_API const double* kw_bezier_points(const kw_bezier* bezier, size_t* count);
KW_API const double* kw_bezier_weights(const kw_bezier* bezier,
                                       size_t* count);  ///< [.. (degree+1)]

/// One curve from segments: ends[segments + 1], points[segments*(degree+1)*dim], and
/// weights[segments*(degree+1)] or none. Ends of neighbours farther apart than join_tolerance make
/// a jump.
KW_API kw_status kw_curve_from_bezier(int32_t degree, int32_t dim, const double* ends,
                                      size_t ends_count, const double* points, size_t points_count,
                                      const double* weights, size_t weights_count,
                                      double join_tolerance, kw_curve** out, kw_error** error);

KW_END
