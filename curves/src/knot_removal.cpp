// SPDX-License-Identifier: MIT
#include "knot_removal.h"

#include <algorithm>

#include "knotwave/base/index.h"

namespace knotwave::curves {
namespace {

using base::index_of;

using Row = std::vector<DoubleDouble>;

// What inserting the knot u `times` times makes of p + 1 points over `knots` [2p+2], one row of
// p + 1 shares each. (Boehm; A5.1.)
std::vector<Row> insertion(const KnotDomain& domain, std::vector<Knot> knots, Knot u, int times) {
  const std::size_t count = knots.size() / 2;
  const int p = static_cast<int>(count) - 1;
  std::vector<Row> rows(count, Row(count));
  for (std::size_t j = 0; j < count; ++j) rows[j][j] = 1.0;
  for (int done = 0; done < times; ++done) {
    const int span = p + done;  // knots[span] <= u < knots[span + 1]
    const std::vector<Row> before = rows;
    rows.insert(rows.begin() + span, Row(count));
    for (int i = span - p + 1; i <= span; ++i) {
      const DoubleDouble below = domain.distance(knots[index_of(i)], u);
      const DoubleDouble above = domain.distance(u, knots[index_of(i + p)]);
      for (std::size_t j = 0; j < count; ++j) {
        rows[index_of(i)][j] =
            (below * before[index_of(i)][j] + above * before[index_of(i - 1)][j]) / (below + above);
      }
    }
    knots.insert(knots.begin() + span + 1, u);
  }
  return rows;
}

// Least squares by modified Gram-Schmidt. The first `unknowns` columns are the equations', the
// others right-hand sides; a solution [unknowns] for each of these.
std::vector<Row> solve_least_squares(std::vector<Row> columns, std::size_t unknowns) {
  const auto dot = [](const Row& a, const Row& b) {
    DoubleDouble sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  };
  std::vector<Row> shares(columns.size(), Row(unknowns));  // of column j in column k
  for (std::size_t j = 0; j < unknowns; ++j) {
    const DoubleDouble square = dot(columns[j], columns[j]);
    for (std::size_t k = j + 1; k < columns.size(); ++k) {
      const DoubleDouble share = dot(columns[j], columns[k]) / square;
      for (std::size_t i = 0; i < columns[k].size(); ++i) {
        columns[k][i] = columns[k][i] - share * columns[j][i];
      }
      shares[k][j] = share;
    }
  }
  for (std::size_t k = unknowns; k < columns.size(); ++k) {
    for (std::size_t j = unknowns; j-- > 0;) {
      for (std::size_t later = j + 1; later < unknowns; ++later) {
        shares[k][j] = shares[k][j] - shares[later][j] * shares[k][later];
      }
    }
  }
  return {shares.begin() + static_cast<long>(unknowns), shares.end()};
}

DoubleDouble& channel(HomogeneousPoint& point, std::size_t c) {
  return c < point.x.size() ? point.x[c] : point.w;
}
constexpr std::size_t kChannels = kMaxDim + 1;

// The points and knots a removal is about: those from p + t before the run's last knot on, which
// may reach into the next period.
struct Window {
  int first = 0;
  int unknowns = 0;                      ///< points 1 .. unknowns of the p + 1 that are to be
  std::vector<HomogeneousPoint> points;  ///< [p+t+1] as they are
  std::vector<Knot> knots;               ///< [2p+2] once the knots are gone
};

Window window_of(const HomogeneousCurve& curve, KnotRun run, int times) {
  const int p = curve.degree, r = run.last;
  const int count = static_cast<int>(curve.points.size()) - (curve.domain.periodic ? p : 0);
  Window window;
  window.first = r - p - times;
  window.unknowns = p - run.times + times - 1;
  for (int i = window.first; i <= r; ++i) {
    const bool beyond = i >= static_cast<int>(curve.points.size());
    window.points.push_back(curve.points[index_of(beyond ? i - count : i)]);
  }
  for (int i = window.first; i <= r + p + 1; ++i) {
    if (i > r - times && i <= r) continue;
    const bool beyond = i >= static_cast<int>(curve.knots.size());
    window.knots.push_back(curve.knots[index_of(beyond ? i - count : i)]);
    if (beyond) ++window.knots.back().period;
  }
  return window;
}

// The unknown points of the window, each channel a row. The first point that is to be is the first
// there is, and those after the unknown ones are the last there are.
std::vector<Row> solve(const Window& window, const KnotDomain& domain, Knot u, int times) {
  const std::vector<Row> rows = insertion(domain, window.knots, u, times);
  const std::size_t unknowns = index_of(window.unknowns), equations = unknowns + index_of(times);
  std::vector<Row> columns(unknowns + kChannels, Row(equations));
  for (std::size_t i = 0; i < equations; ++i) {
    const Row& row = rows[i + 1];
    HomogeneousPoint rest = window.points[i + 1];
    const DoubleDouble scale = DoubleDouble(1.0) / DoubleDouble(rest.w.hi);
    for (std::size_t j = 0; j < row.size(); ++j) {
      if (j >= 1 && j <= unknowns) {
        columns[j - 1][i] = row[j] * scale;
        continue;
      }
      HomogeneousPoint known = window.points[j == 0 ? 0 : j + index_of(times)];
      for (std::size_t c = 0; c < kChannels; ++c) {
        channel(rest, c) = channel(rest, c) - row[j] * channel(known, c);
      }
    }
    for (std::size_t c = 0; c < kChannels; ++c) columns[unknowns + c][i] = channel(rest, c) * scale;
  }
  return solve_least_squares(std::move(columns), unknowns);
}

// A jump with one knot less: both its ends become their mean.
void join_jump(HomogeneousCurve& curve, KnotRun run) {
  const int right = run.last - curve.degree;
  HomogeneousPoint& left = curve.points[index_of(right - 1)];
  left = blend(left, curve.points[index_of(right)], 1.0, 1.0);
  curve.points.erase(curve.points.begin() + right);
  curve.knots.erase(curve.knots.begin() + run.last);
}

}  // namespace

KnotRun run_of(const HomogeneousCurve& curve, double u) {
  const KnotDomain& domain = curve.domain;
  const auto run = [&curve](Knot knot) {
    const auto [first, end] = std::equal_range(curve.knots.begin(), curve.knots.end(), knot);
    const int times = static_cast<int>(end - first);
    return KnotRun{static_cast<int>(end - curve.knots.begin()) - 1, times, times};
  };
  if (u > domain.low && u < domain.high) return run({0, u});
  if (!domain.periodic || (u != domain.low && u != domain.high)) return {};
  // Of the run at the end, the knots up to the end of the domain; at the start, those from it on.
  KnotRun at_end = run({1, domain.low}), at_start = run({0, domain.low});
  at_end.spare = static_cast<int>(curve.points.size()) - (at_end.last - at_end.times + 1);
  at_start.spare = at_start.last - curve.degree;
  return at_end.spare > 0 ? at_end : at_start;
}

bool remove_knots_of(HomogeneousCurve& curve, KnotRun run, int times) {
  const int p = curve.degree;
  const int count = static_cast<int>(curve.points.size()) - (curve.domain.periodic ? p : 0);
  if (count - times < p + 1) return false;
  if (run.times > p && times == 1) {
    join_jump(curve, run);
    return true;
  }
  const Window window = window_of(curve, run, times);
  const Knot u = curve.knots[index_of(run.last)];
  const std::vector<Row> solved = solve(window, curve.domain, u, times);
  for (int j = 0; j < window.unknowns; ++j) {
    HomogeneousPoint& point = curve.points[index_of(window.first + 1 + j)];
    for (std::size_t c = 0; c < kChannels; ++c) channel(point, c) = solved[c][index_of(j)];
    if (!(point.w.hi > 0)) return false;
  }
  const auto stale = curve.points.begin() + window.first + 1 + window.unknowns;
  curve.points.erase(stale, stale + times);
  const auto gone = curve.knots.begin() + run.last + 1;
  curve.knots.erase(gone - times, gone);
  if (curve.domain.periodic) curve.repeat_period(std::min(window.first + 1, p));
  return true;
}

}  // namespace knotwave::curves
