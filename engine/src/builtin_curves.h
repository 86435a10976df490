// SPDX-License-Identifier: MIT
// The four curves a patch may name without drawing them. [control]
#pragma once
#include <span>
#include <string_view>

#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::engine {

/// sine, triangle, saw, square.
std::span<const std::string_view> builtin_curve_names();

/// One cycle over 0..1 from -1 to 1, beginning as a sine does: the triangle at 0 and rising, the
/// saw at -1 and rising, the square high. The sine is a periodic quintic B-spline of 64 points,
/// within 1e-10 of sin(2 pi u). `name` is one of builtin_curve_names().
curves::NurbsCurve builtin_curve(std::string_view name);

}  // namespace knotwave::engine
