// SPDX-License-Identifier: MIT
#include "spec_layout.h"

#include <algorithm>

#include "knotwave/base/index.h"

namespace knotwave::curves {
namespace {
using base::index_of;
}  // namespace

std::vector<double> expanded_knots(std::span<const double> knots, int degree, int count,
                                   bool periodic) {
  const int p = degree, n = count;
  if (!periodic) {
    if (!knots.empty()) return {knots.begin(), knots.end()};
    std::vector<double> clamped(index_of(n + p + 1), 0.0);
    for (int i = p + 1; i < n; ++i) {
      clamped[index_of(i)] = static_cast<double>(i - p) / static_cast<double>(n - p);
    }
    std::fill(clamped.begin() + n, clamped.end(), 1.0);
    return clamped;
  }
  std::vector<double> base(knots.begin(), knots.end());
  for (int i = 0; knots.empty() && i <= n; ++i) {
    base.push_back(static_cast<double>(i) / static_cast<double>(n));
  }
  const double low = base.front(), high = base.back(), period = high - low;
  std::vector<double> all(index_of(n + 2 * p + 1));
  for (int i = 0; i <= n; ++i) all[index_of(p + i)] = base[index_of(i)];
  // A knot on the seam stays exactly on it, whatever the shift rounds to.
  for (int j = 0; j < p; ++j) {
    const double before = base[index_of(n - 1 - j)], after = base[index_of(1 + j)];
    all[index_of(p - 1 - j)] = before == high ? low : std::min(before - period, low);
    all[index_of(p + n + 1 + j)] = after == low ? high : std::max(after + period, high);
  }
  return all;
}

std::vector<double> written_knots(std::span<const double> expanded, int degree, bool periodic) {
  const auto skip = index_of(periodic ? degree : 0);
  const auto kept = expanded.subspan(skip, expanded.size() - 2 * skip);
  return {kept.begin(), kept.end()};
}

std::vector<double> closed_rows(std::vector<double> written, int row, int extra) {
  if (extra == 0) return written;
  std::vector<double> closed;
  for (auto start = written.begin(); start != written.end(); start += row) {
    closed.insert(closed.end(), start, start + row);
    closed.insert(closed.end(), start, start + extra);
  }
  return closed;
}

std::vector<double> open_rows(std::span<const double> closed, int row, int extra) {
  std::vector<double> open;
  for (auto start = closed.begin(); start != closed.end(); start += row + extra) {
    open.insert(open.end(), start, start + row);
  }
  return open;
}

std::vector<double> expanded_weights(std::vector<double> written, int count, int row, int extra) {
  written.resize(index_of(count), 1.0);
  return closed_rows(std::move(written), row, extra);
}

std::vector<double> written_weights(std::span<const double> expanded, int row, int extra) {
  const bool all_one =
      std::all_of(expanded.begin(), expanded.end(), [](double w) { return w == 1.0; });
  return all_one ? std::vector<double>() : open_rows(expanded, row, extra);
}

bool makes_rational(std::span<const double> weights) {
  return std::any_of(weights.begin(), weights.end(),
                     [&](double w) { return w != weights.front(); });
}

}  // namespace knotwave::curves
