// SPDX-License-Identifier: MIT
// One surface to another, one direction at a time, and surfaces made from curves. See
// knotwave/curves/surface_algorithms.h and surface_shapes.h. [control]
#pragma once
#include "knotwave/c/surface.h"

KW_BEGIN

typedef int32_t kw_direction;
enum { KW_DIRECTION_U = 0, KW_DIRECTION_V = 1 };

// Edits that do not change the surface.
KW_API kw_status kw_surface_insert_knot(const kw_surface* surface, kw_direction direction,
                                        double at, int32_t times, kw_surface** out,
                                        kw_error** error);
KW_API kw_status kw_surface_refine(const kw_surface* surface, kw_direction direction,
                                   const double* knots, size_t knots_count, kw_surface** out,
                                   kw_error** error);
KW_API kw_status kw_surface_elevate_degree(const kw_surface* surface, kw_direction direction,
                                           int32_t times, kw_surface** out, kw_error** error);
/// The part over [a, b] of one direction.
KW_API kw_status kw_surface_part(const kw_surface* surface, kw_direction direction, double a,
                                 double b, kw_surface** out, kw_error** error);
/// Both parts at a line of constant u (or v). Neither is made if one cannot be.
KW_API kw_status kw_surface_split(const kw_surface* surface, kw_direction direction, double at,
                                  kw_surface** out_low, kw_surface** out_high, kw_error** error);

// Edits that make a surface smaller. *removed knots, and *max_error, a proved bound of the change;
// both may be NULL.
KW_API kw_status kw_surface_remove_knot(const kw_surface* surface, kw_direction direction,
                                        double at, int32_t times, double tolerance,
                                        kw_surface** out, int32_t* removed, double* max_error,
                                        kw_error** error);
KW_API kw_status kw_surface_reduce_degree(const kw_surface* surface, kw_direction direction,
                                          double tolerance, kw_surface** out, double* max_error,
                                          kw_error** error);

// The same points at another pace.
KW_API kw_status kw_surface_reverse(const kw_surface* surface, kw_direction direction,
                                    kw_surface** out, kw_error** error);
/// Over [a, b] instead.
KW_API kw_status kw_surface_reparametrize(const kw_surface* surface, kw_direction direction,
                                          double a, double b, kw_surface** out, kw_error** error);
/// u and v change places.
KW_API kw_status kw_surface_transpose(const kw_surface* surface, kw_surface** out,
                                      kw_error** error);

// From curves without jumps.
/// Straight lines between the points of two curves, v from 0 to 1.
KW_API kw_status kw_surface_ruled(const kw_curve* first, const kw_curve* second, kw_surface** out,
                                  kw_error** error);
/// Through every row; positions[rows_count] along v, or none: by the distances between rows.
KW_API kw_status kw_surface_lofted(const kw_curve* const* rows, size_t rows_count, int32_t degree_v,
                                   const double* positions, size_t positions_count,
                                   kw_surface** out, kw_error** error);
/// A 2-D profile (distance from the axis, height) turned about the axis; 1 is a whole turn.
KW_API kw_status kw_surface_revolved(const kw_curve* profile, double length_cycles,
                                     kw_surface** out, kw_error** error);
/// From four corners [4*dim]: (0,0), (1,0), (0,1), (1,1).
KW_API kw_status kw_surface_bilinear(const double* corners, size_t corners_count, int32_t dim,
                                     kw_surface** out, kw_error** error);
/// Inside four border curves whose ends meet within `tolerance`.
KW_API kw_status kw_surface_coons(const kw_curve* bottom, const kw_curve* top, const kw_curve* left,
                                  const kw_curve* right, double tolerance, kw_surface** out,
                                  kw_error** error);

KW_END
