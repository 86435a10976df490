// SPDX-License-Identifier: MIT
#include "knotwave/curves/trim_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"
#include "knotwave/curves/algorithms.h"

#include "loop_parts.h"

namespace knotwave::curves {

using base::number_text;

/// The loops as seen along both coordinates: [0] cut where u turns, [1] where v turns.
struct TrimRegion::Borders {
  std::array<std::vector<LoopPart>, 2> parts;
  double slack = 0;  ///< 4 ulp of the largest coordinate
};

namespace {

using base::index_of;

std::string place_text(double u, double v) {
  return "(" + number_text(u) + ", " + number_text(v) + ")";
}

std::string name_of(std::size_t loop) { return "loop " + std::to_string(loop); }

Result<NurbsCurve> clamped(const std::string& loop, const NurbsCurve& curve) {
  const std::string what = loop + ", curve '" + curve.name() + "': ";
  if (curve.dim() != 2) {
    return fail(ErrorCode::dimension_mismatch,
                what + "a loop needs 2 coordinates, found " + std::to_string(curve.dim()));
  }
  if (!curve.jumps().empty()) {
    return fail(ErrorCode::not_closed,
                what + "a jump at u = " + number_text(curve.jumps().front()));
  }
  if (curve.is_clamped() && !curve.is_periodic()) return curve;
  return sub_curve(curve, curve.u_min(), curve.u_max());
}

// Begins where the one before it ends; the last one ends where the first begins.
Result<TrimLoop> joined(const std::string& name, const TrimLoop& loop, double tolerance) {
  std::vector<CurveSpec> specs;
  for (const NurbsCurve& curve : loop) {
    auto open = clamped(name, curve);
    if (!open) return open.error();
    specs.push_back(open->spec());
  }
  for (std::size_t i = 0; i < specs.size(); ++i) {
    CurveSpec &from = specs[i], &to = specs[(i + 1) % specs.size()];
    double* const end = &from.points[from.points.size() - 2];
    double* const start = to.points.data();
    const double gap = std::max(std::abs(end[0] - start[0]), std::abs(end[1] - start[1]));
    if (!(gap <= tolerance)) {
      return fail(ErrorCode::not_closed, name + ": curve '" + from.name + "' ends at " +
                                             place_text(end[0], end[1]) + ", curve '" + to.name +
                                             "' begins at " + place_text(start[0], start[1]) +
                                             ", " + number_text(gap) + " apart; the tolerance is " +
                                             number_text(tolerance));
    }
    const bool closes = i + 1 == specs.size();
    std::copy_n(closes ? start : end, 2, closes ? end : start);
  }
  TrimLoop curves;
  for (CurveSpec& spec : specs) {
    auto curve = NurbsCurve::create(std::move(spec));
    if (!curve) return curve.error();
    curves.push_back(std::move(*curve));
  }
  return curves;
}

// Crossings of the line at `level` with what lies beyond `across`: odd inside a loop.
bool is_inside(std::span<const LoopPart> parts, double level, double across) {
  bool inside = false;
  for (const LoopPart& part : parts) {
    if (part.crosses(level, Side::right) && part.across_at(level) > across) inside = !inside;
  }
  return inside;
}

// A place on a loop, where the line at its level leaves it last, and which way the loop runs.
struct Outline {
  double level = 0;
  double across = 0;
  bool counter_clockwise = false;
};

// Nothing for a loop without area. `parts` by v.
std::optional<Outline> outline_of(std::span<const LoopPart> parts) {
  const auto height = [](const LoopPart& part) { return std::abs(part.level1 - part.level0); };
  const auto tallest =
      std::max_element(parts.begin(), parts.end(),
                       [&](const LoopPart& a, const LoopPart& b) { return height(a) < height(b); });
  if (tallest == parts.end() || tallest->rests()) return std::nullopt;
  Outline outline{0.5 * tallest->level0 + 0.5 * tallest->level1, 0, false};
  bool found = false;
  for (const LoopPart& part : parts) {
    if (!part.crosses(outline.level, Side::right)) continue;
    const double across = part.across_at(outline.level);
    if (found && across <= outline.across) continue;
    outline.across = across;
    outline.counter_clockwise = part.level0 < part.level1;
    found = true;
  }
  return outline;
}

// Whether all loops keep the same: the outermost inside (true) or outside.
Result<bool> keep_inside(std::span<const std::vector<LoopPart>> loops) {
  bool inside = true;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const auto outline = outline_of(loops[i]);
    if (!outline) return fail(ErrorCode::malformed, name_of(i) + " encloses nothing");
    int around = 0;
    for (std::size_t j = 0; j < loops.size(); ++j) {
      if (i != j && is_inside(loops[j], outline->level, outline->across)) ++around;
    }
    const bool outermost = outline->counter_clockwise == (around % 2 == 0);
    if (i == 0) inside = outermost;
    if (outermost == inside) continue;
    const auto way = [](bool counter) { return counter ? "counter-clockwise" : "clockwise"; };
    return fail(ErrorCode::malformed,
                name_of(i) + " runs " + way(outline->counter_clockwise) + " inside " +
                    std::to_string(around) + " others; beside loop 0 it must run " +
                    way(!outline->counter_clockwise) + ": nested loops alternate");
  }
  return inside;
}

}  // namespace

Result<TrimRegion> TrimRegion::create(std::span<const TrimLoop> loops, double tolerance) {
  if (!(tolerance >= 0)) {
    return fail(ErrorCode::value_out_of_range,
                "trim region: a tolerance of " + number_text(tolerance) + " is below 0");
  }
  TrimRegion region;
  Borders borders;
  std::vector<std::vector<LoopPart>> by_v;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (loops[i].empty()) return fail(ErrorCode::not_closed, name_of(i) + " has no curves");
    auto loop = joined(name_of(i), loops[i], tolerance);
    if (!loop) return loop.error();
    by_v.push_back(loop_parts(*loop, 1));
    const auto by_u = loop_parts(*loop, 0);
    borders.parts[0].insert(borders.parts[0].end(), by_u.begin(), by_u.end());
    borders.parts[1].insert(borders.parts[1].end(), by_v.back().begin(), by_v.back().end());
    for (const NurbsCurve& curve : *loop) {
      for (const double x : curve.points()) {
        borders.slack = std::max(borders.slack, 0x1p-50 * std::abs(x));
      }
    }
    region.loops_.push_back(std::move(*loop));
  }
  if (const auto met = find_meeting(by_v)) {
    const std::string where = " near " + place_text(met->x, met->y);
    return fail(ErrorCode::malformed,
                met->first == met->second
                    ? name_of(met->first) + " crosses or touches itself" + where
                    : "loops " + std::to_string(met->first) + " and " +
                          std::to_string(met->second) + " cross or touch" + where);
  }
  if (!loops.empty()) {
    const auto inside = keep_inside(by_v);
    if (!inside) return inside.error();
    region.unbounded_ = !*inside;
  }
  for (auto& parts : borders.parts) {
    std::erase_if(parts, [](const LoopPart& part) { return part.rests(); });
  }
  region.borders_ = std::make_shared<const Borders>(std::move(borders));
  return region;
}

bool TrimRegion::contains(double u, double v) const noexcept {
  if (std::isnan(u) || std::isnan(v)) return false;
  const double slack = borders_->slack;
  for (const int level : {1, 0}) {
    const double at = level == 1 ? v : u, across = level == 1 ? u : v;
    for (const Side side : {Side::right, Side::left}) {
      bool inside = unbounded_;
      for (const LoopPart& part : borders_->parts[index_of(level)]) {
        if (!part.crosses(at, side) || across > part.high + slack) continue;
        const double border = across < part.low - slack ? part.high : part.across_at(at);
        if (std::abs(border - across) <= slack) return true;
        if (border > across) inside = !inside;
      }
      if (inside) return true;
    }
  }
  return false;
}

namespace {

// What is kept beside the line at `at`, in order.
void append_kept(std::vector<Interval>& kept, std::span<const LoopPart> parts, double at, Side side,
                 bool unbounded) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<double> ends;
  if (unbounded) ends.push_back(-kInfinity);
  for (const LoopPart& part : parts) {
    if (part.crosses(at, side)) ends.push_back(part.across_at(at));
  }
  if (unbounded) ends.push_back(kInfinity);
  std::sort(ends.begin(), ends.end());
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2) kept.push_back({ends[i], ends[i + 1]});
}

// Borders count: what is kept on either side of the line is kept on it.
std::vector<Interval> kept_on(std::span<const LoopPart> parts, double at, bool unbounded) {
  if (std::isnan(at)) return {};
  std::vector<Interval> both;
  append_kept(both, parts, at, Side::right, unbounded);
  append_kept(both, parts, at, Side::left, unbounded);
  std::sort(both.begin(), both.end(),
            [](const Interval& a, const Interval& b) { return a.low < b.low; });
  std::vector<Interval> kept;
  for (const Interval& next : both) {
    if (kept.empty() || next.low > kept.back().high) {
      kept.push_back(next);
    } else {
      kept.back().high = std::max(kept.back().high, next.high);
    }
  }
  return kept;
}

}  // namespace

std::vector<Interval> TrimRegion::intervals_at_v(double v) const {
  return kept_on(borders_->parts[1], v, unbounded_);
}

std::vector<Interval> TrimRegion::intervals_at_u(double u) const {
  return kept_on(borders_->parts[0], u, unbounded_);
}

Result<TrimLoop> rectangle_loop(double u_low, double u_high, double v_low, double v_high) {
  if (u_low >= u_high || v_low >= v_high) {
    return fail(ErrorCode::empty_domain, "a rectangle from " + place_text(u_low, v_low) + " to " +
                                             place_text(u_high, v_high) + " has no area");
  }
  CurveSpec spec;
  spec.name = "rectangle";
  spec.degree = 1;
  spec.dim = 2;
  spec.points = {u_low, v_low, u_high, v_low, u_high, v_high, u_low, v_high, u_low, v_low};
  auto curve = NurbsCurve::create(std::move(spec));
  if (!curve) return curve.error();
  return TrimLoop{std::move(*curve)};
}

}  // namespace knotwave::curves
