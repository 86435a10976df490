// SPDX-License-Identifier: MIT
// Curves and surfaces from bytes, and what holds for each of them. Sizes are capped so that an
// input takes milliseconds: degree 15, 9 points more than the degree, 4 coordinates, of surfaces
// degree 7 and 5 points more.
#pragma once
#include <initializer_list>
#include <optional>

#include "knotwave/curves/nurbs_curve.h"
#include "knotwave/curves/nurbs_surface.h"

#include "byte_reader.h"
#include "fuzz_check.h"

namespace knotwave::fuzz {

/// A curve that create() takes, or none where the spec is wrong and the error says so.
std::optional<curves::NurbsCurve> curve_from(ByteReader& bytes);
std::optional<curves::NurbsSurface> surface_from(ByteReader& bytes);

/// A place to look at: a knot, one beside it, an end, between.
double place_in(ByteReader& bytes, std::span<const double> knots, double low, double high);

double ulp_of(double x);
double largest_coordinate(std::span<const double> points);
/// One ulp of max|P|.
double ulp_of(const curves::NurbsCurve& curve);

/// Its spec makes it again; values are inside the range of the points, from either side.
void check_curve(const curves::NurbsCurve& curve);
void check_surface(const curves::NurbsSurface& surface);
/// A message, and a code the header names.
void check_refusal(const Error& error, std::initializer_list<ErrorCode> named);

/// `edited` is `curve` over [low, high], within `tolerance` in every coordinate: at both sides of
/// knots of either and between.
void check_same(const curves::NurbsCurve& curve, const curves::NurbsCurve& edited, double low,
                double high, double tolerance);
void check_same(const curves::NurbsSurface& surface, const curves::NurbsSurface& edited,
                double tolerance);

}  // namespace knotwave::fuzz
