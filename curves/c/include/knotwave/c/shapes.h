// SPDX-License-Identifier: MIT
// Curves that have a name, and the paths of SVG. See knotwave/curves/shapes.h and svg_path.h.
// [control]
#pragma once
#include "knotwave/c/curve_set.h"

KW_BEGIN

/// Bézier curve of points [n*dim] over [0, 1], degree n - 1.
KW_API kw_status kw_shape_bezier(const double* points, size_t points_count, int32_t dim,
                                 kw_curve** out, kw_error** error);
/// Arc about (0, 0); angles in cycles, a negative length is clockwise.
KW_API kw_status kw_shape_arc(double radius, double start_cycles, double length_cycles,
                              kw_curve** out, kw_error** error);
KW_API kw_status kw_shape_ellipse(double radius_x, double radius_y, kw_curve** out,
                                  kw_error** error);
/// From p0[2] to p2[2], tangents meet in p1[2], shape factor w.
KW_API kw_status kw_shape_conic(const double* p0, const double* p1, const double* p2, double w,
                                kw_curve** out, kw_error** error);
/// From 1 to -range_db, straight in decibels within *max_error_db, which may be NULL.
KW_API kw_status kw_shape_exponential_decay(double range_db, kw_curve** out, double* max_error_db,
                                            kw_error** error);
/// CSS cubic-bezier(x1, y1, x2, y2).
KW_API kw_status kw_shape_css_cubic_bezier(double x1, double y1, double x2, double y2,
                                           kw_curve** out, kw_error** error);
/// Cubic through values[n*dim] at times[n] with slopes[n*dim] on either side of each.
KW_API kw_status kw_shape_hermite(const double* times, size_t times_count, const double* values,
                                  const double* slopes_in, const double* slopes_out,
                                  size_t values_count, int32_t dim, kw_curve** out,
                                  kw_error** error);
/// Through points [n*dim]; alpha 0 uniform, 0.5 centripetal, 1 chordal.
KW_API kw_status kw_shape_catmull_rom(const double* points, size_t points_count, int32_t dim,
                                      double alpha, bool closed, kw_curve** out, kw_error** error);

/// In SVG y grows downwards; KW_SVG_Y_UP changes its sign on the way.
typedef int32_t kw_svg_y;
enum { KW_SVG_Y_UP = 0, KW_SVG_Y_DOWN = 1 };
/// The subpaths of the attribute `d` as curves "path_1" and so on.
KW_API kw_status kw_curve_set_from_svg_path(const char* d, size_t d_count, kw_svg_y y,
                                            kw_curve_set** out, kw_error** error);
/// Path data within max_error of the curve; *bound is how near it is, and may be NULL. Free the
/// text with kw_text_free().
KW_API kw_status kw_curve_to_svg_path(const kw_curve* curve, double max_error, kw_svg_y y,
                                      char** out, double* bound, kw_error** error);

KW_END
