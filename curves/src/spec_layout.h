// SPDX-License-Identifier: MIT
// What create() keeps of a checked spec, and the spec again. The points of a curve are one row,
// those of a surface several; a periodic row is kept with its first p points again at its end.
#pragma once
#include <span>
#include <vector>

namespace knotwave::curves {

/// The knots create() keeps: those given, or clamped uniform on [0, 1] (periodic: uniform), and for
/// a periodic direction with p more on either side, shifted by a period and rounded (knot_domain.h
/// reads them exactly).
std::vector<double> expanded_knots(std::span<const double> knots, int degree, int count,
                                   bool periodic);
std::vector<double> written_knots(std::span<const double> expanded, int degree, bool periodic);

/// Each row of `row` numbers with its first `extra` numbers again at its end, and without them.
std::vector<double> closed_rows(std::vector<double> written, int row, int extra);
std::vector<double> open_rows(std::span<const double> closed, int row, int extra);

/// As above for `count` weights in all; none written means 1 each, and back.
std::vector<double> expanded_weights(std::vector<double> written, int count, int row, int extra);
std::vector<double> written_weights(std::span<const double> expanded, int row, int extra);

/// Whether weights differ: equal ones cancel.
bool makes_rational(std::span<const double> weights);

}  // namespace knotwave::curves
