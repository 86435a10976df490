// SPDX-License-Identifier: MIT
// Surfaces: made, asked, evaluated. See knotwave/curves/nurbs_surface.h.
#pragma once
#include "knotwave/c/curve.h"

KW_BEGIN

typedef struct kw_surface kw_surface;

/// What a surface is made of. kw_surface_spec spec = KW_SURFACE_SPEC_INIT; then set what differs.
typedef struct kw_surface_spec {
  size_t struct_size;  ///< set by KW_SURFACE_SPEC_INIT
  const char* name;    ///< for messages and files; NULL = ""
  int32_t degree_u;
  int32_t degree_v;
  int32_t dim;
  int32_t count_u;       ///< points in a row
  int32_t count_v;       ///< rows
  const double* points;  ///< [count_v*count_u*dim]: rows of u, one row a v
  size_t points_count;
  const double* weights;  ///< [count_v*count_u], or none: all 1
  size_t weights_count;
  const double* knots_u;  ///< as kw_curve_spec.knots
  size_t knots_u_count;
  const double* knots_v;
  size_t knots_v_count;
  bool periodic_u;  ///< rows are closed
} kw_surface_spec;
#define KW_SURFACE_SPEC_INIT \
  { sizeof(kw_surface_spec), NULL, 3, 3, 1, 0, 0, NULL, 0, NULL, 0, NULL, 0, NULL, 0, false }

/// Checks the spec and copies it. [control]
KW_API kw_status kw_surface_create(const kw_surface_spec* spec, kw_surface** out, kw_error** error);
KW_API kw_status kw_surface_copy(const kw_surface* surface, kw_surface** out, kw_error** error);
KW_API void kw_surface_free(kw_surface* surface);
KW_API bool kw_surface_equal(const kw_surface* first, const kw_surface* second);

// What a surface is. [any] Arrays and the name are borrowed, their count goes to *count.
KW_API const char* kw_surface_name(const kw_surface* surface);
KW_API int32_t kw_surface_degree_u(const kw_surface* surface);
KW_API int32_t kw_surface_degree_v(const kw_surface* surface);
KW_API int32_t kw_surface_dim(const kw_surface* surface);
KW_API bool kw_surface_is_rational(const kw_surface* surface);
KW_API bool kw_surface_is_periodic_u(const kw_surface* surface);
KW_API int32_t kw_surface_count_u(const kw_surface* surface);  ///< as evaluated
KW_API int32_t kw_surface_count_v(const kw_surface* surface);
KW_API double kw_surface_u_min(const kw_surface* surface);
KW_API double kw_surface_u_max(const kw_surface* surface);
KW_API double kw_surface_v_min(const kw_surface* surface);
KW_API double kw_surface_v_max(const kw_surface* surface);
KW_API const double* kw_surface_points(const kw_surface* surface, size_t* count);
KW_API const double* kw_surface_weights(const kw_surface* surface, size_t* count);
KW_API const double* kw_surface_knots_u(const kw_surface* surface, size_t* count);
KW_API const double* kw_surface_knots_v(const kw_surface* surface, size_t* count);

/// S(u, v) to out[dim]. [any] Parameters are clamped (u wrapped if periodic), NaN counts as
/// minimum.
KW_API kw_status kw_surface_evaluate(const kw_surface* surface, double u, double v, double* out,
                                     size_t out_count);
/// S at every (u[i], v[j]) to out[(j*u_count+i)*dim]. [any]
KW_API kw_status kw_surface_evaluate_grid(const kw_surface* surface, const double* u,
                                          size_t u_count, const double* v, size_t v_count,
                                          double* out, size_t out_count);
/// d^(k+l)S / du^k dv^l with k + l <= order to out[(k*(order+1)+l)*dim], the rest 0; out has
/// [(order+1)*(order+1)*dim]. [any] order 0..15.
KW_API kw_status kw_surface_derivatives(const kw_surface* surface, double u, double v,
                                        int32_t order, double* out, size_t out_count);

/// The curves u -> S(u, v) and v -> S(u, v). [control]
KW_API kw_status kw_surface_iso_curve_at_v(const kw_surface* surface, double v, kw_curve** out,
                                           kw_error** error);
KW_API kw_status kw_surface_iso_curve_at_u(const kw_surface* surface, double u, kw_curve** out,
                                           kw_error** error);

KW_END
