// SPDX-License-Identifier: MIT
// Parts of loops are apart when a line separates their hulls. Where none does, both are halved. A
// part and the next one share a corner: a line through it then has to do.
#include <algorithm>
#include <array>
#include <cmath>

#include "curve_distance.h"
#include "loop_parts.h"

namespace knotwave::curves {
namespace {

struct Vector {
  double x = 0, y = 0;
};
Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y}; }
double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y; }
Vector across(Vector a) { return {-a.y, a.x}; }

constexpr int kMostHalvings = 40;
// Pairs of strokes looked at: for all, and for each part more. Strokes that run beside each other
// at a distance d of their length take some d^(-1/2).
constexpr int kMostPairs = 1 << 18;
constexpr int kMostPairsOfAPart = 64;

// A part of a part, and whether it still has that one's ends.
struct Stroke {
  std::vector<HomogeneousPoint> points;
  bool has_start = true;
  bool has_end = true;
};

std::array<Stroke, 2> halves_of(const Stroke& stroke) {
  Stroke left = stroke;
  Stroke right{halve(left.points), false, stroke.has_end};
  left.has_end = false;
  return {std::move(left), std::move(right)};
}

// Which ends of the two strokes are one corner.
struct Joints {
  bool end_to_start = false;  ///< the end of the first is the start of the second
  bool start_to_end = false;
};

using Hull = std::vector<Vector>;

// Seen from `origin`, so that small hulls keep their digits.
Hull hull_of(const Stroke& stroke, const HomogeneousPoint& origin) {
  Hull hull;
  for (const HomogeneousPoint& point : stroke.points) {
    const auto from_origin = [&](std::size_t c) {
      return (point.x[c] / point.w - origin.x[c] / origin.w).hi;
    };
    hull.push_back({from_origin(0), from_origin(1)});
  }
  return hull;
}

bool separates(Vector normal, const Hull& a, const Hull& b) {
  const auto less = [&](Vector p, Vector q) { return dot(normal, p) < dot(normal, q); };
  const auto [low_a, high_a] = std::minmax_element(a.begin(), a.end(), less);
  const auto [low_b, high_b] = std::minmax_element(b.begin(), b.end(), less);
  return less(*high_a, *low_b) || less(*high_b, *low_a);
}

bool are_apart(const Stroke& first, const Stroke& second) {
  const Hull a = hull_of(first, first.points.front()), b = hull_of(second, first.points.front());
  const Vector normals[] = {{1, 0},
                            {0, 1},
                            across(a.back() - a.front()),
                            across(b.back() - b.front()),
                            b[b.size() / 2] - a[a.size() / 2]};
  return std::any_of(std::begin(normals), std::end(normals),
                     [&](Vector normal) { return separates(normal, a, b); });
}

// Both hulls as seen from the corner, which is the last of `a` and the first of `b`.
bool meet_in_corner_only(const Hull& a, const Hull& b) {
  const Vector to_a = a.front(), to_b = b.back();
  const double far_a = std::sqrt(dot(to_a, to_a)), far_b = std::sqrt(dot(to_b, to_b));
  if (!(far_a > 0 && far_b > 0)) return false;
  const Vector normal =
      Vector{to_b.x / far_b, to_b.y / far_b} - Vector{to_a.x / far_a, to_a.y / far_a};
  return std::all_of(a.begin(), a.end() - 1, [&](Vector p) { return dot(normal, p) < 0; }) &&
         std::all_of(b.begin() + 1, b.end(), [&](Vector p) { return dot(normal, p) > 0; });
}

Vector place_of(const Stroke& stroke) {
  double place[2];
  stroke.points.front().project(place);
  return {place[0], place[1]};
}

// Where the two meet, if they may. `pairs` is how many more may be looked at: they do, if that is
// not enough.
std::optional<Vector> meeting_of(const Stroke& a, const Stroke& b, Joints joints, int halvings,
                                 long& pairs) {
  if (--pairs < 0) return place_of(a);
  const bool forward = joints.end_to_start && a.has_end && b.has_start;
  const bool backward = joints.start_to_end && a.has_start && b.has_end;
  if (!forward && !backward && are_apart(a, b)) return std::nullopt;
  if (forward && !backward &&
      meet_in_corner_only(hull_of(a, a.points.back()), hull_of(b, a.points.back()))) {
    return std::nullopt;
  }
  if (backward && !forward &&
      meet_in_corner_only(hull_of(b, b.points.back()), hull_of(a, b.points.back()))) {
    return std::nullopt;
  }
  if (halvings == kMostHalvings) {
    if (forward || backward) return std::nullopt;  // a cusp
    return place_of(a);
  }
  for (const Stroke& part : halves_of(a)) {
    for (const Stroke& other : halves_of(b)) {
      if (auto met = meeting_of(part, other, joints, halvings + 1, pairs)) return met;
    }
  }
  return std::nullopt;
}

struct Box {
  double level_low, level_high, across_low, across_high;
};
Box box_of(const LoopPart& part) {
  return {std::min(part.level0, part.level1), std::max(part.level0, part.level1), part.low,
          part.high};
}
bool are_apart(const Box& a, const Box& b) {
  return a.level_high < b.level_low || b.level_high < a.level_low || a.across_high < b.across_low ||
         b.across_high < a.across_low;
}

Stroke stroke_of(const LoopPart& part) {
  Stroke stroke;
  for (std::size_t j = 0; j < part.weight.size(); ++j) {
    HomogeneousPoint& point = stroke.points.emplace_back();
    point.x[0] = part.across[j];
    point.x[1] = part.level[j];
    point.w = part.weight[j];
  }
  return stroke;
}

}  // namespace

std::optional<Meeting> find_meeting(std::span<const std::vector<LoopPart>> loops) {
  struct Named {
    std::size_t loop, index;
    Box box;
  };
  std::vector<Named> all;
  for (std::size_t loop = 0; loop < loops.size(); ++loop) {
    for (std::size_t i = 0; i < loops[loop].size(); ++i) {
      all.push_back({loop, i, box_of(loops[loop][i])});
    }
  }
  long pairs = kMostPairs + kMostPairsOfAPart * static_cast<long>(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      const Named &a = all[i], &b = all[j];
      if (are_apart(a.box, b.box)) continue;
      const std::size_t size = loops[a.loop].size();
      const bool same = a.loop == b.loop;
      const Joints joints{same && b.index == a.index + 1,
                          same && a.index == 0 && b.index == size - 1};
      const auto met = meeting_of(stroke_of(loops[a.loop][a.index]),
                                  stroke_of(loops[b.loop][b.index]), joints, 0, pairs);
      if (met) return Meeting{a.loop, b.loop, met->x, met->y};
    }
  }
  return std::nullopt;
}

}  // namespace knotwave::curves
