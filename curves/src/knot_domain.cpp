// SPDX-License-Identifier: MIT
#include "knot_domain.h"

#include <cmath>

namespace knotwave::curves {

double KnotDomain::place(double u, Side side) const KNOTWAVE_RT {
  if (std::isnan(u)) return low;
  if (!periodic) return std::clamp(u, low, high);
  if (!std::isfinite(u)) return low;
  if (u < low || u >= high) {
    const DoubleDouble period = DoubleDouble::difference(high, low);
    const double periods = std::floor((u - low) / period.hi);
    u = (DoubleDouble(u) - period * DoubleDouble(periods)).hi;
    if (!(u >= low && u < high)) u = low;  // one rounding below a whole number of periods
  }
  return side == Side::left && u == low ? high : u;
}

DoubleDouble KnotDomain::distance_across_seams(Knot from, Knot to) const noexcept {
  DoubleDouble sum = DoubleDouble::difference(to.at, low);
  sum += DoubleDouble::difference(high, from.at);
  for (int i = from.period + 1; i < to.period; ++i) sum += DoubleDouble::difference(high, low);
  return sum;
}

double KnotDomain::rounded(Knot knot) const noexcept {
  if (knot.period == 0) return knot.at;
  if (knot == Knot{1, low}) return high;
  const DoubleDouble period = DoubleDouble::difference(high, low);
  return (DoubleDouble(knot.at) + period * DoubleDouble(static_cast<double>(knot.period))).hi;
}

Knot KnotSequence::knot_of_period(int i) const noexcept {
  const int n = static_cast<int>(expanded.size()) - 2 * degree - 1;  // knots of a period
  const int period = i < degree ? -1 : i >= degree + n ? 1 : 0;
  const int own = i - period * n;
  return domain().knot(expanded[static_cast<std::size_t>(own)], period);
}

std::vector<Knot> KnotSequence::all() const {
  std::vector<Knot> knots;
  knots.reserve(expanded.size());
  for (int i = 0; i < static_cast<int>(expanded.size()); ++i) knots.push_back((*this)[i]);
  return knots;
}

}  // namespace knotwave::curves
