// SPDX-License-Identifier: MIT
// What a curve does: its range, where it takes a value, how much it moves. See
// knotwave/curves/analysis.h and algorithms.h. [control]
#pragma once
#include "knotwave/c/curve.h"

KW_BEGIN

/// Where a curve is lowest or highest.
typedef struct kw_extremum {
  double u;
  double value;
} kw_extremum;
/// Least and greatest value of a coordinate; either may be NULL.
KW_API kw_status kw_curve_value_range(const kw_curve* curve, int32_t coordinate, kw_extremum* low,
                                      kw_extremum* high, kw_error** error);
/// Least and greatest control point: the curve never leaves them. Either may be NULL.
KW_API kw_status kw_curve_hull_range(const kw_curve* curve, int32_t coordinate, double* low,
                                     double* high, kw_error** error);
/// Every u, in order, where the coordinate is `value`.
KW_API kw_status kw_curve_parameters_at(const kw_curve* curve, double value, int32_t coordinate,
                                        kw_doubles* out, kw_error** error);
/// Sum of all rises and falls.
KW_API kw_status kw_curve_total_variation(const kw_curve* curve, int32_t coordinate, double* out,
                                          kw_error** error);
/// Rows of 4, one a span of positive length: u0, u1, low, high.
KW_API kw_status kw_curve_span_hulls(const kw_curve* curve, int32_t coordinate, kw_doubles* out,
                                     kw_error** error);
/// Rows of 3, one a knot where a derivative up to max_order jumps: u, order, size.
/// KW_VALUE_OUT_OF_RANGE: max_order above 1000.
KW_API kw_status kw_curve_breaks(const kw_curve* curve, int32_t max_order, int32_t coordinate,
                                 kw_doubles* out, kw_error** error);
/// Where the curve is nearest to point[dim], and how near; either result may be NULL.
KW_API kw_status kw_curve_closest_point(const kw_curve* curve, const double* point,
                                        size_t point_count, double* u, double* distance,
                                        kw_error** error);
/// Whether a coordinate never decreases.
KW_API kw_status kw_curve_is_non_decreasing(const kw_curve* curve, int32_t coordinate, bool* out,
                                            kw_error** error);
/// [kw_curve_point_count()], never wrapped: the u where each control point pulls most.
KW_API kw_status kw_curve_greville_abscissae(const kw_curve* curve, kw_doubles* out,
                                             kw_error** error);

KW_END
