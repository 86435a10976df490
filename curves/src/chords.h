// SPDX-License-Identifier: MIT
// Distances between neighbours in a row of points. Private to curves. [control]
#pragma once
#include <span>
#include <vector>

namespace knotwave::curves {

/// Euclidean, [n - 1] for points [n * dim].
std::vector<double> chords(std::span<const double> points, int dim);

}  // namespace knotwave::curves
