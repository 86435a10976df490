// SPDX-License-Identifier: MIT
#include "knot_removal.h"

#include <algorithm>

namespace knotwave::curves {
namespace {

std::size_t index_of(int i) { return static_cast<std::size_t>(i); }

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
  const int p = curve.degree, r = run.last, s = run.times, t = times;
  const bool periodic = curve.domain.periodic;
  const int count = static_cast<int>(curve.points.size()) - (periodic ? p : 0);
  if (count - t < p + 1) return false;
  std::vector<HomogeneousPoint>& points = curve.points;
  if (s > p && t == 1) {  // a jump: both its ends become their mean
    HomogeneousPoint& left = points[index_of(r - s)];
    left = blend(left, points[index_of(r - p)], 1.0, 1.0);
    points.erase(points.begin() + (r - p));
    curve.knots.erase(curve.knots.begin() + r);
    return true;
  }
  // The p + t + 1 points from `first` on come from p + 1: the first of these and the last s - t + 1
  // are points of the curve already, the others are sought.
  const int first = r - p - t;
  const auto unknowns = index_of(p - s + t - 1), equations = unknowns + index_of(t);
  const auto point = [&](std::size_t i) {  // the window may reach into the next period
    return points[i < points.size() ? i : i - index_of(count)];
  };
  std::vector<Knot> knots;
  for (int i = first; i <= r + p + 1; ++i) {
    const bool beyond = i >= static_cast<int>(curve.knots.size());
    knots.push_back(curve.knots[index_of(beyond ? i - count : i)]);
    if (beyond) ++knots.back().period;
  }
  const Knot u = curve.knots[index_of(r)];
  knots.erase(knots.begin() + (r - t + 1 - first), knots.begin() + (r + 1 - first));
  const std::vector<Row> rows = insertion(curve.domain, knots, u, t);
  std::vector<Row> columns(unknowns + kChannels, Row(equations));
  for (std::size_t i = 0; i < equations; ++i) {
    const Row& row = rows[i + 1];
    HomogeneousPoint rest = point(index_of(first + 1) + i);
    const DoubleDouble scale = DoubleDouble(1.0) / DoubleDouble(rest.w.hi);
    for (std::size_t j = 0; j < row.size(); ++j) {
      if (j >= 1 && j <= unknowns) {
        columns[j - 1][i] = row[j] * scale;
        continue;
      }
      HomogeneousPoint known = point(index_of(first) + j + (j == 0 ? 0 : index_of(t)));
      for (std::size_t c = 0; c < kChannels; ++c) {
        channel(rest, c) = channel(rest, c) - row[j] * channel(known, c);
      }
    }
    for (std::size_t c = 0; c < kChannels; ++c) columns[unknowns + c][i] = channel(rest, c) * scale;
  }
  const std::vector<Row> solved = solve_least_squares(std::move(columns), unknowns);
  for (std::size_t j = 0; j < unknowns; ++j) {
    for (std::size_t c = 0; c < kChannels; ++c) {
      channel(points[index_of(first + 1) + j], c) = solved[c][j];
    }
    if (!(points[index_of(first + 1) + j].w.hi > 0)) return false;
  }
  const auto stale = points.begin() + first + 1 + static_cast<long>(unknowns);
  points.erase(stale, stale + t);
  curve.knots.erase(curve.knots.begin() + r - t + 1, curve.knots.begin() + r + 1);
  if (periodic) curve.repeat_period(std::min(first + 1, p));
  return true;
}

}  // namespace knotwave::curves
