// SPDX-License-Identifier: MIT
#include "knotwave/curves/map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"
#include "knotwave/curves/compile.h"

namespace knotwave::curves {
namespace {

using base::index_of;
std::size_t index_of(Target target) KNOTWAVE_RT { return static_cast<std::size_t>(target); }

/// Nodes of a grid that are worked on together.
constexpr std::size_t kNodes = 64;

Result<void> check_target(Target target) {
  if (is_target(target)) return {};
  return fail(ErrorCode::value_out_of_range,
              "map: target " + std::to_string(static_cast<int>(target)) + " is outside 0.." +
                  std::to_string(kTargetCount - 1));
}

Result<void> check_range(Target target, const char* name, double x1, double x2) {
  const std::string what = std::string("map of ") + to_string(target) + ": ";
  for (const double x : {x1, x2}) {
    if (!std::isfinite(x)) {
      return fail(ErrorCode::not_finite, what + "an end of " + name + " is not finite");
    }
    if (std::abs(x) > kMaxKnot) {
      return fail(ErrorCode::value_out_of_range, what + name + " = " + base::number_text(x) +
                                                     " is outside -" + base::number_text(kMaxKnot) +
                                                     ".." + base::number_text(kMaxKnot));
    }
  }
  if (x1 == x2) {
    return fail(ErrorCode::empty_domain,
                what + name + "1 and " + name + "2 are both " + base::number_text(x1));
  }
  if (std::abs(x2 - x1) >= kMinKnotStep) return {};
  return fail(ErrorCode::value_out_of_range, what + name + "1 (" + base::number_text(x1) +
                                                 ") and " + name + "2 (" + base::number_text(x2) +
                                                 ") differ by less than " +
                                                 base::number_text(kMinKnotStep));
}

Result<void> check_width(Target target, int width) {
  if (width <= widest(target)) return {};
  return fail(ErrorCode::dimension_mismatch,
              std::string("map of ") + to_string(target) + ": " + std::to_string(width) +
                  " coordinates, the target takes " + std::to_string(widest(target)) + " at most");
}

/// A slope by the map's own parameter as one by the common coordinate; beyond all doubles it is the
/// largest with its sign.
double rescaled(double slope, double scale) KNOTWAVE_RT {
  constexpr double kLargest = std::numeric_limits<double>::max();
  return std::clamp(slope * scale, -kLargest, kLargest);
}

/// Whether a map with key `a` is evaluated rather than one with key `b`.
bool goes_before(const MapKey& a, const MapKey& b) KNOTWAVE_RT {
  return a.width != b.width ? a.width > b.width : a.rational && !b.rational;
}

}  // namespace

const char* to_string(Target target) noexcept {
  constexpr std::array<const char*, kTargetCount> kNames = {
      "amp",    "pitch",     "pan",        "phase",     "wave_position",
      "cutoff", "resonance", "drive",      "crossfade", "control_point",
      "weight", "knot",      "time_scale", "position",  "modulation",
      "free_1", "free_2",    "free_3",     "free_4"};
  return is_target(target) ? kNames[index_of(target)] : "unknown";
}

MapSet::Stretch::Stretch(double x1, double x2, double first, double last) noexcept
    : from(x1), to(x2), low(first), high(last), scale((last - first) / (x2 - x1)) {}

bool MapSet::Stretch::holds(double x) const KNOTWAVE_RT {
  return x >= std::min(from, to) && x <= std::max(from, to);
}

MapSet::MapSet() {
  chosen_curves_.fill(-1);
  chosen_surfaces_.fill(-1);
}

template <class Slot>
void MapSet::keep(std::vector<Slot>& slots, Slot slot) {
  const auto found = std::find_if(slots.begin(), slots.end(),
                                  [&](const Slot& other) { return other.key == slot.key; });
  if (found == slots.end()) {
    slots.push_back(std::move(slot));
  } else {
    *found = std::move(slot);
  }
}

template <class Slot>
void MapSet::choose(const std::vector<Slot>& slots, Chosen& chosen) KNOTWAVE_RT {
  chosen.fill(-1);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (!slots[i].enabled) continue;
    std::int16_t& best = chosen[index_of(slots[i].key.target)];
    if (best < 0 || goes_before(slots[i].key, slots[index_of(best)].key)) {
      best = static_cast<std::int16_t>(i);
    }
  }
}

Result<MapKey> MapSet::define(Map1 map) {
  if (auto ok = check_target(map.target); !ok) return ok.error();
  if (auto ok = check_range(map.target, "u", map.u1, map.u2); !ok) return ok.error();
  if (auto ok = check_width(map.target, map.curve.dim()); !ok) return ok.error();
  CompileOptions options;
  options.max_error = map.max_error;
  auto program = compile_parametric(map.curve, options);
  if (!program) return std::move(program).error();
  const MapKey key{map.target, 1, map.curve.dim(), map.curve.is_rational()};
  const Stretch u(map.u1, map.u2, program->u_min(), program->u_max());
  keep(curves_, Curve{key, false, std::move(map), std::move(*program), u});
  choose(curves_, chosen_curves_);
  return key;
}

Result<MapKey> MapSet::define(Map2 map) {
  if (auto ok = check_target(map.target); !ok) return ok.error();
  if (auto ok = check_range(map.target, "u", map.u1, map.u2); !ok) return ok.error();
  if (auto ok = check_range(map.target, "v", map.v1, map.v2); !ok) return ok.error();
  if (auto ok = check_width(map.target, map.surface.dim()); !ok) return ok.error();
  auto program = compile_surface(map.surface);
  if (!program) return std::move(program).error();
  const MapKey key{map.target, 2, map.surface.dim(), map.surface.is_rational()};
  const Stretch u(map.u1, map.u2, program->u_min(), program->u_max());
  const Stretch v(map.v1, map.v2, program->v_min(), program->v_max());
  keep(surfaces_, Surface{key, false, std::move(map), std::move(*program), u, v});
  choose(surfaces_, chosen_surfaces_);
  return key;
}

bool MapSet::enable(const MapKey& key, bool on) KNOTWAVE_RT {
  const auto set = [&](auto& slots, Chosen& chosen) {
    for (auto& slot : slots) {
      if (!(slot.key == key)) continue;
      slot.enabled = on;
      choose(slots, chosen);
      return true;
    }
    return false;
  };
  return key.parameters == 2 ? set(surfaces_, chosen_surfaces_) : set(curves_, chosen_curves_);
}

bool MapSet::is_enabled(const MapKey& key) const KNOTWAVE_RT {
  const auto enabled = [&](const auto& slot) { return slot.key == key && slot.enabled; };
  return std::any_of(curves_.begin(), curves_.end(), enabled) ||
         std::any_of(surfaces_.begin(), surfaces_.end(), enabled);
}

void MapSet::set_current(Target target, std::span<const double> value) KNOTWAVE_RT {
  const std::size_t count = std::min(value.size(), index_of(widest(target)));
  for (std::size_t c = 0; c < count; ++c) {
    if (!std::isnan(value[c])) current_[index_of(target)][c] = value[c];
  }
}

std::span<const double> MapSet::current(Target target) const KNOTWAVE_RT {
  if (!is_target(target)) return {};
  return std::span(current_[index_of(target)]).first(index_of(widest(target)));
}

void MapSet::take_current(MapValues& out) const KNOTWAVE_RT {
  out.numbers = current_;
  for (int t = 0; t < kTargetCount; ++t) {
    out.width[index_of(t)] = widest(static_cast<Target>(t));
    out.evaluated[index_of(t)] = false;
  }
}

void MapSet::take_nothing(MapValues& out) const KNOTWAVE_RT {
  take_current(out);
  for (auto& numbers : out.numbers) numbers.fill(0);
}

void MapSet::evaluate(double u, MapValues& out) const KNOTWAVE_RT {
  take_current(out);
  for (std::size_t t = 0; t < chosen_curves_.size(); ++t) {
    if (chosen_curves_[t] < 0) continue;
    const Curve& slot = curves_[index_of(chosen_curves_[t])];
    const double local = slot.u.at(u);
    out.evaluated[t] = true;
    out.width[t] = slot.key.width;
    for (int c = 0; c < slot.key.width; ++c) {
      out.numbers[t][index_of(c)] = slot.program.at_u(local, c);
    }
  }
}

void MapSet::evaluate(double u, double v, MapValues& out) const KNOTWAVE_RT {
  take_current(out);
  for (std::size_t t = 0; t < chosen_surfaces_.size(); ++t) {
    if (chosen_surfaces_[t] < 0) continue;
    const Surface& slot = surfaces_[index_of(chosen_surfaces_[t])];
    const double local_u = slot.u.at(u), local_v = slot.v.at(v);
    out.evaluated[t] = true;
    out.width[t] = slot.key.width;
    for (int c = 0; c < slot.key.width; ++c) {
      out.numbers[t][index_of(c)] = slot.program.at(local_u, local_v, c);
    }
  }
}

void MapSet::evaluate_slopes(double u, MapValues& by_u) const KNOTWAVE_RT {
  take_nothing(by_u);
  for (std::size_t t = 0; t < chosen_curves_.size(); ++t) {
    if (chosen_curves_[t] < 0) continue;
    const Curve& slot = curves_[index_of(chosen_curves_[t])];
    by_u.evaluated[t] = true;
    by_u.width[t] = slot.key.width;
    if (!slot.program.is_periodic() && !slot.u.holds(u)) continue;
    for (int c = 0; c < slot.key.width; ++c) {
      by_u.numbers[t][index_of(c)] =
          rescaled(slot.program.slope_at_u(slot.u.at(u), c), slot.u.scale);
    }
  }
}

void MapSet::evaluate_slopes(double u, double v, MapValues& by_u,
                             MapValues& by_v) const KNOTWAVE_RT {
  take_nothing(by_u);
  take_nothing(by_v);
  for (std::size_t t = 0; t < chosen_surfaces_.size(); ++t) {
    if (chosen_surfaces_[t] < 0) continue;
    const Surface& slot = surfaces_[index_of(chosen_surfaces_[t])];
    by_u.evaluated[t] = by_v.evaluated[t] = true;
    by_u.width[t] = by_v.width[t] = slot.key.width;
    const bool moves_u = slot.program.is_periodic_u() || slot.u.holds(u);
    for (int c = 0; c < slot.key.width; ++c) {
      const auto slopes = slot.program.slopes_at(slot.u.at(u), slot.v.at(v), c);
      if (moves_u) by_u.numbers[t][index_of(c)] = rescaled(slopes.by_u, slot.u.scale);
      if (slot.v.holds(v)) by_v.numbers[t][index_of(c)] = rescaled(slopes.by_v, slot.v.scale);
    }
  }
}

void MapSet::fill_held(const Channel& channel, bool is_evaluated) const KNOTWAVE_RT {
  const bool has_current =
      !is_evaluated && channel.coordinate >= 0 && channel.coordinate < widest(channel.target);
  const double value =
      has_current ? current_[index_of(channel.target)][index_of(channel.coordinate)] : 0.0;
  std::fill(channel.out.begin(), channel.out.end(), value);
}

void MapSet::evaluate_grid(const MapGrid& grid, std::int64_t first,
                           std::span<const Channel> channels) const KNOTWAVE_RT {
  for (const Channel& channel : channels) {
    const int chosen = is_target(channel.target) ? chosen_curves_[index_of(channel.target)] : -1;
    const int width = chosen < 0 ? 0 : curves_[index_of(chosen)].key.width;
    if (channel.coordinate < 0 || channel.coordinate >= width) {
      fill_held(channel, chosen >= 0);
      continue;
    }
    const Curve& slot = curves_[index_of(chosen)];
    CurveCursor cursor;
    double u[kNodes];
    for (std::size_t done = 0; done < channel.out.size(); done += kNodes) {
      const std::size_t count = std::min(kNodes, channel.out.size() - done);
      for (std::size_t i = 0; i < count; ++i) {
        u[i] = slot.u.at(grid.at(first + static_cast<std::int64_t>(done + i)));
      }
      slot.program.render(std::span<const double>(u, count), channel.out.subspan(done, count),
                          cursor, channel.coordinate);
    }
  }
}

void MapSet::evaluate_mesh(const MapGrid& grid_u, std::int64_t first_u, std::int64_t count_u,
                           const MapGrid& grid_v, std::int64_t first_v,
                           std::span<const Channel> channels) const KNOTWAVE_RT {
  if (count_u < 1) return;
  for (const Channel& channel : channels) {
    const int chosen = is_target(channel.target) ? chosen_surfaces_[index_of(channel.target)] : -1;
    const int width = chosen < 0 ? 0 : surfaces_[index_of(chosen)].key.width;
    if (channel.coordinate < 0 || channel.coordinate >= width) {
      fill_held(channel, chosen >= 0);
      continue;
    }
    const Surface& slot = surfaces_[index_of(chosen)];
    const auto row = static_cast<std::size_t>(count_u);
    for (std::size_t done = 0; done < channel.out.size();) {
      const std::size_t i = done % row,
                        count = std::min({kNodes, row - i, channel.out.size() - done});
      double u[kNodes];
      for (std::size_t k = 0; k < count; ++k) {
        u[k] = slot.u.at(grid_u.at(first_u + static_cast<std::int64_t>(i + k)));
      }
      const double v = slot.v.at(grid_v.at(first_v + static_cast<std::int64_t>(done / row)));
      slot.program.render_row(std::span<const double>(u, count), v,
                              channel.out.subspan(done, count), channel.coordinate);
      done += count;
    }
  }
}

const Map1* MapSet::map1(const MapKey& key) const KNOTWAVE_RT {
  for (const Curve& slot : curves_) {
    if (slot.key == key) return &slot.map;
  }
  return nullptr;
}

const Map2* MapSet::map2(const MapKey& key) const KNOTWAVE_RT {
  for (const Surface& slot : surfaces_) {
    if (slot.key == key) return &slot.map;
  }
  return nullptr;
}

}  // namespace knotwave::curves
