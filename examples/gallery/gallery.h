// SPDX-License-Identifier: MIT
// The pictures. Each writes FOLDER/NAME.svg and, beside it, FOLDER/NAME.wav: the same curve, heard.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/curves/map.h"

namespace gallery {

/// de Casteljau's construction of a Bézier curve with 3 or 4 points, as string art.
knotwave::Result<void> string_art(const std::string& folder, int points);
/// The four weights that the points of a cubic have along it.
knotwave::Result<void> bernstein(const std::string& folder);
/// A bi-cubic Bézier surface from 16 points.
knotwave::Result<void> surface(const std::string& folder);
/// The basis functions of a B-spline while one of its knots moves.
knotwave::Result<void> moving_knot(const std::string& folder);

/// A curve bound to a target over 0..1 and enabled.
knotwave::Result<void> bind(knotwave::curves::MapSet& maps, knotwave::curves::Target target,
                            const knotwave::Result<knotwave::curves::NurbsCurve>& curve);
/// One coordinate of a target at the n + 1 nodes of a grid over 0..1.
std::vector<double> over_grid(const knotwave::curves::MapSet& maps, knotwave::curves::Target target,
                              int coordinate, std::size_t n);

}  // namespace gallery
