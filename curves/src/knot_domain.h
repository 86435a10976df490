// SPDX-License-Identifier: MIT
// Knots without rounding. Beyond the ends of a periodic curve a knot is one of the period's own,
// some whole periods away: the sum need not be a double, so it is never formed. What algorithms
// need are distances, and those are sums of distances inside one period, none of them negative.
#pragma once
#include <algorithm>
#include <compare>
#include <span>
#include <vector>

#include "knotwave/curves/nurbs_curve.h"

#include "double_double.h"

namespace knotwave::curves {

/// at + period * (length of a period). Not periodic: period is 0.
struct Knot {
  int period = 0;
  double at = 0;

  friend constexpr bool operator==(const Knot&, const Knot&) = default;
  friend constexpr std::partial_ordering operator<=>(const Knot& a, const Knot& b) {
    return a.period != b.period ? std::partial_ordering(a.period <=> b.period) : a.at <=> b.at;
  }
};

/// Where a curve is defined, and what a parameter outside of it means.
struct KnotDomain {
  double low = 0;
  double high = 1;
  bool periodic = false;

  /// u inside [low, high]: clamped, or wrapped (high becomes low, except for Side::left, where low
  /// becomes high) and rounded once. NaN and infinite phases count as low.
  double place(double u, Side side) const KNOTWAVE_RT;
  /// The one name a knot has: the end of a period is the start of the next.
  Knot knot(double u, int period = 0) const noexcept {
    return periodic && u == high ? Knot{period + 1, low} : Knot{period, u};
  }
  /// to - from for from <= to, right to 2^-103 of itself.
  DoubleDouble distance(Knot from, Knot to) const noexcept {
    if (from.period == to.period) return DoubleDouble::difference(to.at, from.at);
    return distance_across_seams(from, to);
  }
  double rounded(Knot knot) const noexcept;

 private:
  DoubleDouble distance_across_seams(Knot from, Knot to) const noexcept;
};

/// The knots that create() keeps, expanded_knots(), as they are meant.
struct KnotSequence {
  std::span<const double> expanded;  ///< [n+p+1]
  int degree = 0;
  bool periodic = false;

  KnotDomain domain() const noexcept {
    const auto p = static_cast<std::size_t>(degree);
    return {expanded[p], expanded[expanded.size() - p - 1], periodic};
  }
  Knot operator[](int i) const noexcept {
    return periodic ? knot_of_period(i) : Knot{0, expanded[static_cast<std::size_t>(i)]};
  }
  std::vector<Knot> all() const;

 private:
  Knot knot_of_period(int i) const noexcept;
};

/// find_span() for knots of either kind.
template <class K>
int span_of(std::span<const K> knots, int degree, const K& u, Side side) noexcept {
  const auto first = knots.begin() + degree;
  const auto last = knots.end() - degree - 1;  // the end of the domain
  const bool at_start = !(u > *first);
  const bool at_end = u >= *last;
  const bool from_left = at_end || (side == Side::left && !at_start);
  const K& bounded = at_start ? *first : at_end ? *last : u;
  const auto above =
      from_left ? std::lower_bound(first, last, bounded) : std::upper_bound(first, last, bounded);
  return static_cast<int>(above - knots.begin()) - 1;
}

}  // namespace knotwave::curves
