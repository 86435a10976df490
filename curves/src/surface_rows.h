// SPDX-License-Identifier: MIT
// A surface as curves in one direction: its control points row by row. Edits are linear in weighted
// points, so what an edit does to a surface it does to each row alone. Private to curves. [control]
#pragma once
#include <span>
#include <vector>

#include "knotwave/curves/surface_algorithms.h"

namespace knotwave::curves {

/// u: count_v rows; v: as many columns as there are points written in a row. All have the knots of
/// that direction, and the name of the surface.
std::vector<NurbsCurve> rows_along(const NurbsSurface& surface, Direction direction);

/// `surface` with other rows in that direction, all over one knot vector. Errors: those of
/// NurbsSurface::create().
Result<NurbsSurface> with_rows(const NurbsSurface& surface, Direction direction,
                               std::span<const NurbsCurve> rows);

/// Rows of u, one a v. Errors: those of NurbsSurface::create().
Result<NurbsSurface> surface_of_rows(std::string name, std::span<const NurbsCurve> rows,
                                     int degree_v, std::vector<double> knots_v);

/// Compatible curves as the rows of a surface: rows that are not rational have weights of 1, as
/// equal ones cancel in a row, but would not beside other rows. Errors: those of make_compatible(),
/// unsupported (a jump).
Result<std::vector<NurbsCurve>> compatible_rows(std::span<const NurbsCurve> curves);

/// "surface 'pad' along v": what messages begin with.
std::string name_along(const NurbsSurface& surface, Direction direction);

/// What is wrong with a row, as said of the surface.
Error told_of(const NurbsSurface& surface, Direction direction, Error error);

}  // namespace knotwave::curves
