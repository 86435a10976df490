// SPDX-License-Identifier: MIT
// Edits of surfaces, one direction at a time: what algorithms.h, reparametrize.h and reduce.h do to
// curves, done to every row along u or every column along v. [control] The result has the name of
// the surface. Messages say the direction. Errors are those of the curve edit of that name, and
// those of NurbsSurface::create (too_many_points: of all rows together).
// Source: Piegl & Tiller, The NURBS Book, 2nd ed.: 5.2 to 5.6 (surfaces).
#pragma once
#include <span>

#include "knotwave/curves/nurbs_surface.h"

namespace knotwave::curves {

enum class Direction { u, v };

/// Knots in, a degree more: the same surface, each point rounded once, within 4 ulp of max|P|. Rows
/// that are periodic stay so; unclamped ones become clamped by elevation.
Result<NurbsSurface> insert_knot(const NurbsSurface& surface, Direction direction, double at,
                                 int times = 1);
Result<NurbsSurface> refine(const NurbsSurface& surface, Direction direction,
                            std::span<const double> knots);
Result<NurbsSurface> elevate_degree(const NurbsSurface& surface, Direction direction,
                                    int times = 1);

/// The part over [a, b] of one direction, clamped there; periodic rows are cut open.
Result<NurbsSurface> sub_surface(const NurbsSurface& surface, Direction direction, double a,
                                 double b);
struct SurfacePair {
  NurbsSurface low;
  NurbsSurface high;
};
/// Both parts at a line of constant u (or v), strictly inside the domain.
Result<SurfacePair> split(const NurbsSurface& surface, Direction direction, double at);

/// Backwards over the same domain; and over another domain. Points are kept to the bit.
Result<NurbsSurface> reverse(const NurbsSurface& surface, Direction direction);
Result<NurbsSurface> reparametrize(const NurbsSurface& surface, Direction direction, double a,
                                   double b);

/// u and v change places: T(u, v) = S(v, u), to the bit. Errors: unsupported (periodic rows:
/// sub_surface() cuts them open).
Result<NurbsSurface> transpose(const NurbsSurface& surface);

/// A smaller surface, and how far no point of it is from the one of the old surface at the same
/// (u, v): Euclidean, output units, rounding included. A bound, proved from the Bézier points of
/// the rows; for rows that differ much it may be several times the error there is.
struct ReducedSurface {
  NurbsSurface surface;
  int removed = 0;       ///< knots, or degrees
  double max_error = 0;  ///< 0 if nothing was removed
};
/// Takes the inner knot `at` out as often as it can be, `times` at most, within `tolerance`: all
/// rows at once, each by least squares. What was inserted comes out at a tolerance of a few ulp of
/// max|P|, and the knots are what they were.
Result<ReducedSurface> remove_knot(const NurbsSurface& surface, Direction direction, double at,
                                   int times, double tolerance);
/// One degree less. Errors: error_bound_missed (the message has the error it would make).
Result<ReducedSurface> reduce_degree(const NurbsSurface& surface, Direction direction,
                                     double tolerance);

}  // namespace knotwave::curves
