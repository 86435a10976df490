// SPDX-License-Identifier: MIT
// Knots out of a curve. Private to curves. [control]
// Source: Lyche & Mørken, Knot removal for parametric B-spline curves and surfaces, CAGD 4 (1987):
// least squares on the coefficients.
#pragma once
#include "homogeneous.h"

namespace knotwave::curves {

/// The equal knots [last - times + 1 .. last].
struct KnotRun {
  int last = 0;
  int times = 0;
  int spare = 0;  ///< how many can be taken out at once
};

/// Where the knot u is in `curve`. The seam of a periodic curve is one place, with a run at the end
/// of a period and its image at the start: the one that has knots to spare, all but the last one.
/// spare = 0 if u is no knot that can be taken out.
KnotRun run_of(const HomogeneousCurve& curve, double u);

/// Takes `times` <= run.spare knots of `run` out. False, and `curve` is not to be used, if there
/// are no points to spare or a weight would not be positive.
///
/// Inserting the knots again would make the points P_i as blends of the new ones Q_j. These are
/// more equations than unknowns; solved by least squares, each P_i counted relative to its weight,
/// they miss by no more than what rounding did to the P_i, however small a weight is beside
/// another. The curve moves by no more than the equations miss. (A5.8 solves from both ends, lets
/// the middle equation miss, and takes one knot after another, each with the noise of the one
/// before.)
bool remove_knots_of(HomogeneousCurve& curve, KnotRun run, int times);

}  // namespace knotwave::curves
