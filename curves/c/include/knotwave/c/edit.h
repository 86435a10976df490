// SPDX-License-Identifier: MIT
// One curve to another: knots, degree, parts, pace, repair. See knotwave/curves/algorithms.h,
// reduce.h, reparametrize.h and monotone.h. [control]
#pragma once
#include "knotwave/c/curve.h"

KW_BEGIN

// Edits that do not change the curve.
KW_API kw_status kw_curve_insert_knot(const kw_curve* curve, double u, int32_t times,
                                      kw_curve** out, kw_error** error);
/// All of `knots`, in any order, repeated ones as often as they are there.
KW_API kw_status kw_curve_refine(const kw_curve* curve, const double* knots, size_t knots_count,
                                 kw_curve** out, kw_error** error);
KW_API kw_status kw_curve_elevate_degree(const kw_curve* curve, int32_t times, kw_curve** out,
                                         kw_error** error);
/// The part over [u_a, u_b].
KW_API kw_status kw_curve_part(const kw_curve* curve, double u_a, double u_b, kw_curve** out,
                               kw_error** error);
/// Both parts at u. Neither is made if one cannot be.
KW_API kw_status kw_curve_split(const kw_curve* curve, double u, kw_curve** out_left,
                                kw_curve** out_right, kw_error** error);

// Edits that make a curve smaller. *removed knots or degrees, and *max_error, a proved bound of the
// change; both may be NULL.
KW_API kw_status kw_curve_remove_knot(const kw_curve* curve, double u, int32_t times,
                                      double tolerance, kw_curve** out, int32_t* removed,
                                      double* max_error, kw_error** error);
/// As many as the tolerance allows, cheapest first: a simpler curve.
KW_API kw_status kw_curve_remove_knots(const kw_curve* curve, double tolerance, kw_curve** out,
                                       int32_t* removed, double* max_error, kw_error** error);
KW_API kw_status kw_curve_reduce_degree(const kw_curve* curve, double tolerance, kw_curve** out,
                                        double* max_error, kw_error** error);

// The same path at another pace.
KW_API kw_status kw_curve_reverse(const kw_curve* curve, kw_curve** out, kw_error** error);
/// Over [u_a, u_b] instead.
KW_API kw_status kw_curve_reparametrize(const kw_curve* curve, double u_a, double u_b,
                                        kw_curve** out, kw_error** error);
/// The Möbius pace: 1 changes nothing, above 1 starts slower; bend 1 / b undoes bend b.
KW_API kw_status kw_curve_bend(const kw_curve* curve, double b, kw_curve** out, kw_error** error);

// Time that goes back, repaired.
typedef int32_t kw_regularization;
enum {
  KW_REGULARIZE_NONE = 0,
  KW_REGULARIZE_CONTAIN = 1,
  KW_REGULARIZE_KEEP_START = 2,
  KW_REGULARIZE_KEEP_RATIO = 3,
  KW_REGULARIZE_LIMIT_ACTIVE = 4,
  KW_REGULARIZE_LIMIT_OPPOSITE = 5
};
/// Every cubic Bézier segment of a 2-D polynomial cubic, along its own handles.
KW_API kw_status kw_curve_regularize(const kw_curve* curve, kw_regularization mode, kw_curve** out,
                                     kw_error** error);
/// Lengths of a segment's handles, *a of the start and *b of the end, as parts of its time. [any]
KW_API kw_status kw_regularize_handles(double* a, double* b, kw_regularization mode,
                                       bool active_is_start);
/// Whether x of the cubic Bézier (0, a, 1 - b, 1) never goes back: exact. [any]
KW_API bool kw_is_monotone_cubic(double a, double b);

KW_END
