// SPDX-License-Identifier: MIT
// Surfaces for property tests.
#pragma once
#include "knotwave/curves/nurbs_surface.h"

#include "random_curve.h"

namespace knotwave::test {

/// Degrees to 7 and 5, knots uniform or not, repeated now and then, periodic along u half the time.
curves::SurfaceSpec random_surface_spec(Dice& dice);
curves::NurbsSurface random_surface(Dice& dice);

/// Farthest that `edited` at (u, v) is from `surface` at (u, v), over places of both domains, in
/// ulp of max|P|.
double surface_distance_ulp(Dice& dice, const curves::NurbsSurface& surface,
                            const curves::NurbsSurface& edited);

}  // namespace knotwave::test
