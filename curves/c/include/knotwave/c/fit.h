// SPDX-License-Identifier: MIT
// Curves from data. See knotwave/curves/fit.h. [control]
#pragma once
#include "knotwave/c/curve.h"

KW_BEGIN

typedef int32_t kw_spacing;
enum { KW_SPACING_UNIFORM = 0, KW_SPACING_CHORD = 1, KW_SPACING_CENTRIPETAL = 2 };

/// Through every point [n*dim], over [0, 1].
KW_API kw_status kw_curve_interpolate(const double* points, size_t points_count, int32_t dim,
                                      int32_t degree, kw_spacing spacing, kw_curve** out,
                                      kw_error** error);
/// Through point i at parameters[i], strictly increasing.
KW_API kw_status kw_curve_interpolate_at(const double* parameters, size_t parameters_count,
                                         const double* points, size_t points_count, int32_t dim,
                                         int32_t degree, kw_curve** out, kw_error** error);
/// Least squares with `point_count` control points at parameters[n], values[n*dim]. *max_error is
/// the largest distance at the data; may be NULL.
KW_API kw_status kw_curve_approximate(const double* parameters, size_t parameters_count,
                                      const double* values, size_t values_count, int32_t dim,
                                      int32_t degree, int32_t point_count, kw_curve** out,
                                      double* max_error, kw_error** error);
/// values[n*dim] over times[n] as a curve with few points, everywhere within `tolerance` of the
/// straight lines from one datum to the next. *max_error, a proved bound, may be NULL.
KW_API kw_status kw_curve_reduce_data(const double* times, size_t times_count, const double* values,
                                      size_t values_count, int32_t dim, double tolerance,
                                      int32_t degree, kw_curve** out, double* max_error,
                                      kw_error** error);

KW_END
