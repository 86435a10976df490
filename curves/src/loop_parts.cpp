// SPDX-License-Identifier: MIT
#include "loop_parts.h"

#include <algorithm>

#include "coordinate_pieces.h"

namespace knotwave::curves {
namespace {

// Bernstein coefficients as points' coordinates.
void measure(LoopPart& part) {
  part.low = part.high = part.across0;
  for (std::size_t j = 0; j < part.weight.size(); ++j) {
    const double x = (part.across[j] / part.weight[j]).hi;
    part.low = std::min(part.low, x);
    part.high = std::max(part.high, x);
  }
  part.low = std::min(part.low, part.across1);
  part.high = std::max(part.high, part.across1);
}

bool is_a_place(const LoopPart& part) {
  const auto same = [&](const Bernstein& x, double at) {
    for (std::size_t j = 0; j < x.size(); ++j) {
      if ((x[j] / part.weight[j]).hi != at) return false;
    }
    return true;
  };
  return same(part.level, part.level0) && same(part.across, part.across0);
}

}  // namespace

bool LoopPart::crosses(double at, Side side) const noexcept {
  const double low_end = std::min(level0, level1), high_end = std::max(level0, level1);
  return side == Side::right ? low_end <= at && at < high_end : low_end < at && at <= high_end;
}

double LoopPart::across_at(double at) const noexcept {
  if (at == level0) return across0;
  if (at == level1) return across1;
  DoubleDouble above[kMaxDegree + 1];
  const std::size_t size = level.size();
  for (std::size_t j = 0; j < size; ++j) above[j] = level[j] - weight[j] * DoubleDouble(at);
  const bool rises = level0 < level1;
  double from = 0, to = 1;
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    const double middle = 0.5 * (from + to);
    const double there = scaled_value(std::span(above, size), middle).hi;
    ((rises ? there < 0 : there > 0) ? from : to) = middle;
  }
  return std::clamp(quotient_at(across, weight, to).hi, low, high);
}

std::vector<LoopPart> loop_parts(std::span<const NurbsCurve> loop, int level) {
  std::vector<LoopPart> parts;
  for (const NurbsCurve& curve : loop) {
    const auto levels = coordinate_pieces(curve, level);
    const auto others = coordinate_pieces(curve, 1 - level);
    for (const MonotonePart& part : monotone_parts(levels, curve.is_rational())) {
      const auto cut = [&](const Bernstein& whole) { return part_of(whole, part.t0, part.t1); };
      const CoordinatePiece &along = levels[part.piece], &other = others[part.piece];
      LoopPart& added = parts.emplace_back();
      added.level = cut(along.numerator);
      added.across = cut(other.numerator);
      added.weight = cut(along.weight);
      added.level0 = part.value0.hi;
      added.level1 = part.value1.hi;
      added.across0 = other.at(part.t0).hi;
      added.across1 = other.at(part.t1).hi;
    }
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const LoopPart& before = parts[i == 0 ? parts.size() - 1 : i - 1];
    parts[i].level0 = before.level1;
    parts[i].across0 = before.across1;
    measure(parts[i]);
  }
  std::erase_if(parts, is_a_place);
  return parts;
}

}  // namespace knotwave::curves
