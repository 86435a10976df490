// SPDX-License-Identifier: MIT
// Curves: made, asked, evaluated. See knotwave/curves/nurbs_curve.h and extrapolate.h.
#pragma once
#include "knotwave/c/status.h"

KW_BEGIN

#define KW_MAX_DEGREE 15
#define KW_MAX_DIM 4
#define KW_MAX_POINTS 4096

typedef struct kw_curve kw_curve;

/// What a curve is made of. kw_curve_spec spec = KW_CURVE_SPEC_INIT; then set what differs.
typedef struct kw_curve_spec {
  size_t struct_size;    ///< set by KW_CURVE_SPEC_INIT
  const char* name;      ///< for messages and files; NULL = ""
  int32_t degree;        ///< 1..KW_MAX_DEGREE
  int32_t dim;           ///< numbers a point, 1..KW_MAX_DIM
  const double* points;  ///< [n*dim], a point's numbers together, not pre-weighted
  size_t points_count;
  const double* weights;  ///< [n], or none: all 1
  size_t weights_count;
  const double* knots;  ///< [n+degree+1], periodic [n+1], or none: uniform on [0, 1]
  size_t knots_count;
  const double* jumps;  ///< inner knots that may come degree + 1 times
  size_t jumps_count;
  bool periodic;  ///< closed; each point listed once
} kw_curve_spec;
#define KW_CURVE_SPEC_INIT \
  { sizeof(kw_curve_spec), NULL, 3, 1, NULL, 0, NULL, 0, NULL, 0, NULL, 0, false }

/// Checks the spec and copies it. [control]
KW_API kw_status kw_curve_create(const kw_curve_spec* spec, kw_curve** out, kw_error** error);
KW_API kw_status kw_curve_copy(const kw_curve* curve, kw_curve** out, kw_error** error);
/// The same curve under another name.
KW_API kw_status kw_curve_renamed(const kw_curve* curve, const char* name, kw_curve** out,
                                  kw_error** error);
KW_API void kw_curve_free(kw_curve* curve);

/// Same name, points, weights, knots and jumps, to the bit. [any]
KW_API bool kw_curve_equal(const kw_curve* first, const kw_curve* second);

// What a curve is. [any] Arrays and the name are borrowed, their count goes to *count.
KW_API const char* kw_curve_name(const kw_curve* curve);
KW_API int32_t kw_curve_degree(const kw_curve* curve);
KW_API int32_t kw_curve_dim(const kw_curve* curve);
KW_API bool kw_curve_is_rational(const kw_curve* curve);
KW_API bool kw_curve_is_periodic(const kw_curve* curve);
KW_API bool kw_curve_is_clamped(const kw_curve* curve);
KW_API double kw_curve_u_min(const kw_curve* curve);
KW_API double kw_curve_u_max(const kw_curve* curve);
/// n as evaluated: a periodic curve has its first `degree` points again at the end.
KW_API size_t kw_curve_point_count(const kw_curve* curve);
KW_API const double* kw_curve_points(const kw_curve* curve, size_t* count);   ///< [n*dim]
KW_API const double* kw_curve_weights(const kw_curve* curve, size_t* count);  ///< [n], 1 without
KW_API const double* kw_curve_knots(const kw_curve* curve, size_t* count);    ///< [n+degree+1]
KW_API const double* kw_curve_jumps(const kw_curve* curve, size_t* count);

/// Which limit at a knot: the value of the span to its right or to its left.
typedef int32_t kw_side;
enum { KW_SIDE_RIGHT = 0, KW_SIDE_LEFT = 1 };

/// C(u) to out[dim]: the exact value, rounded once. [any] u is clamped to the domain (wrapped if
/// periodic), NaN counts as u_min. The sides differ at jumps only.
KW_API kw_status kw_curve_evaluate(const kw_curve* curve, double u, kw_side side, double* out,
                                   size_t out_count);
/// C at many places, in any order, to out[u_count*dim]. [any]
KW_API kw_status kw_curve_evaluate_many(const kw_curve* curve, const double* u, size_t u_count,
                                        kw_side side, double* out, size_t out_count);
/// C and its first `order` derivatives by u to out[(order+1)*dim], value first. [any] order
/// 0..1000.
KW_API kw_status kw_curve_derivatives(const kw_curve* curve, double u, int32_t order, kw_side side,
                                      double* out, size_t out_count);

/// What a curve does beyond its ends.
typedef int32_t kw_extrapolation;
enum {
  KW_EXTRAPOLATE_HOLD = 0,
  KW_EXTRAPOLATE_LINEAR = 1,
  KW_EXTRAPOLATE_PERIODIC = 2,
  KW_EXTRAPOLATE_MIRROR = 3
};
/// C(u) for any u to out[dim]. [any]
KW_API kw_status kw_curve_evaluate_extrapolated(const kw_curve* curve, double u,
                                                kw_extrapolation before, kw_extrapolation after,
                                                double* out, size_t out_count);

/// Signed curvature of a path, or of the graph of a scalar curve; 0 where a path stands still.
/// [any]
KW_API kw_status kw_curve_curvature(const kw_curve* curve, double u, kw_side side, double* out);

KW_END
