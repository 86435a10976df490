// SPDX-License-Identifier: MIT
// Maps of a patch: which numbers of curves they move, and the order everything is computed in.
#include <algorithm>

#include "patch_compiler.h"

namespace knotwave::engine {
namespace {

constexpr bool moves_a_number(const MapSpec& map) {
  return map.target == MapTarget::curve_weight || map.target == MapTarget::curve_point;
}

constexpr bool varies_by_itself(MapSource source) {
  return source == MapSource::envelope || source == MapSource::lfo;
}

std::string map_name(std::size_t number) { return "map " + std::to_string(number + 1); }

}  // namespace

Result<void> PatchCompiler::collect_moved_numbers() {
  for (std::size_t i = 0; i < spec_.maps.size(); ++i) {
    const MapSpec& map = spec_.maps[i];
    if (!map.enabled || !moves_a_number(map)) continue;
    MovedNumber moved;
    moved.curve = map.target_curve;
    moved.map = static_cast<int>(i);
    moved.range.kind = map.target == MapTarget::curve_weight
                           ? curves::ControlRange::Kind::weight
                           : curves::ControlRange::Kind::coordinate;
    moved.range.point = map.target_point;
    moved.range.coordinate = map.target == MapTarget::curve_weight ? 0 : map.target_coordinate;
    moved.range.low = map.low;
    moved.range.high = map.high;
    if (auto found = curve(moved.curve, map_name(i)); !found) return found.error();
    for (const MovedNumber& other : moved_) {
      if (other.curve != moved.curve || other.range.kind != moved.range.kind ||
          other.range.point != moved.range.point ||
          other.range.coordinate != moved.range.coordinate)
        continue;
      return fail(ErrorCode::control_conflict,
                  map_name(static_cast<std::size_t>(other.map)) + " and " + map_name(i) +
                      " move the same number of curve '" + moved.curve + "' (point " +
                      std::to_string(moved.range.point) + ")");
    }
    moved_.push_back(std::move(moved));
  }
  return {};
}

std::vector<int> PatchCompiler::moved_numbers_of(const std::string& curve_name) const {
  std::vector<int> found;
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    if (moved_[i].curve == curve_name) found.push_back(static_cast<int>(i));
  }
  return found;
}

Result<void> PatchCompiler::compile_maps() {
  for (std::size_t i = 0; i < spec_.maps.size(); ++i) {
    if (!spec_.maps[i].enabled) continue;
    if (auto done = compile_map(spec_.maps[i], i); !done) return in_role(done.error(), map_name(i));
  }
  return {};
}

Result<void> PatchCompiler::check_map(const MapSpec& map) const {
  const auto out_of_range = [](const char* what, int index, std::size_t count) {
    return fail(ErrorCode::value_out_of_range, std::string(what) + " " + std::to_string(index) +
                                                   " does not exist; there are " +
                                                   std::to_string(count));
  };
  const auto source_fault = [&](MapSource source, int index) -> Result<void> {
    const std::size_t count = source == MapSource::envelope ? spec_.envelopes.size()
                              : source == MapSource::lfo    ? spec_.lfos.size()
                                                            : 128;
    if (index >= 0 && static_cast<std::size_t>(index) < count) return {};
    return out_of_range("source", index, count);
  };
  if (auto ok = source_fault(map.source, map.source_index); !ok) return ok;
  if (auto ok = source_fault(map.source_v, map.source_v_index); !ok) return ok;
  const std::size_t oscillators = spec_.oscillators.size();
  const int index = map.target_index;
  const bool is_oscillator = index >= 0 && static_cast<std::size_t>(index) < oscillators;
  const bool is_noise = index == kNoiseSource;
  switch (map.target) {
    case MapTarget::level:
      if (!is_oscillator && !is_noise) return out_of_range("oscillator", index, oscillators);
      break;
    case MapTarget::gain:
    case MapTarget::pan:
      if (index >= 0 && !is_oscillator && !is_noise)
        return out_of_range("oscillator", index, oscillators);
      break;
    case MapTarget::pitch:
      if (index >= 0 && !is_oscillator) return out_of_range("oscillator", index, oscillators);
      break;
    case MapTarget::phase:
    case MapTarget::position:
      if (!is_oscillator) return out_of_range("oscillator", index, oscillators);
      break;
    case MapTarget::lfo_rate:
      if (index < 0 || static_cast<std::size_t>(index) >= spec_.lfos.size())
        return out_of_range("lfo", index, spec_.lfos.size());
      break;
    case MapTarget::envelope_time:
      if (index < 0 || static_cast<std::size_t>(index) >= spec_.envelopes.size())
        return out_of_range("envelope", index, spec_.envelopes.size());
      if (varies_by_itself(map.source) || (!map.surface.empty() && varies_by_itself(map.source_v)))
        return fail(ErrorCode::unsupported,
                    "an envelope's time is read once, when a note starts; an envelope or LFO "
                    "cannot move it");
      break;
    default:
      break;
  }
  return {};
}

Result<void> PatchCompiler::compile_map(const MapSpec& map, std::size_t number) {
  if (auto ok = check_map(map); !ok) return ok;
  PatchProgram::MapPart part;
  part.source = map.source;
  part.source_index = map.source_index;
  part.depth = map.depth;
  part.smooth_s = std::max(map.smooth_s, 0.0);
  int index = map.target_index;
  if (moves_a_number(map)) {
    part.is_control = true;
    part.low = map.low;
    part.high = map.high;
    for (std::size_t i = 0; i < moved_.size(); ++i) {
      if (moved_[i].map == static_cast<int>(number)) index = static_cast<int>(i);
    }
  }
  part.slot = slot_of(map.target, index);
  if (!map.curve.empty()) {
    auto found = curve(map.curve, "its curve");
    if (!found) return found.error();
    curves::CompileOptions options;
    for (const int moved : moved_numbers_of(map.curve)) {
      options.controls.push_back(moved_[static_cast<std::size_t>(moved)].range);
      part.control_slots.push_back(kSlotControl + moved);
    }
    auto program = curves::compile_function(**found, options);
    if (!program) return program.error();
    part.curve = *std::move(program);
  } else if (!map.surface.empty()) {
    const curves::NurbsSurface* surface = spec_.curves.find_surface(map.surface);
    if (surface == nullptr) {
      return fail(ErrorCode::unknown_name, "no surface '" + map.surface + "'");
    }
    if (surface->dim() != 1) {
      return fail(ErrorCode::not_scalar, "surface '" + map.surface + "' has " +
                                             std::to_string(surface->dim()) +
                                             " coordinates; a map needs 1");
    }
    part.source_v = map.source_v;
    part.source_v_index = map.source_v_index;
    part.surface = *surface;
  }
  program_->maps_.push_back(std::move(part));
  return {};
}

// Takes, again and again, the first thing all of whose inputs are computed. What is left over
// when nothing more can be taken moves itself.
Result<void> PatchCompiler::make_schedule() {
  const auto maps = std::span<const PatchProgram::MapPart>(program_->maps_);
  const std::size_t envelopes = program_->envelopes_.size(), lfos = program_->lfos_.size();
  std::vector<bool> map_done(maps.size()), envelope_done(envelopes), lfo_done(lfos);
  const auto slot_is_ready = [&](int slot) {
    for (std::size_t i = 0; i < maps.size(); ++i) {
      if (maps[i].slot == slot && !map_done[i]) return false;
    }
    return true;
  };
  const auto all_ready = [&](const std::vector<int>& slots) {
    return std::all_of(slots.begin(), slots.end(), slot_is_ready);
  };
  const auto source_is_ready = [&](MapSource source, int index) {
    const auto i = static_cast<std::size_t>(index);
    return source == MapSource::envelope ? bool(envelope_done[i])
           : source == MapSource::lfo    ? bool(lfo_done[i])
                                         : true;
  };
  using Kind = PatchProgram::Step::Kind;
  const std::size_t total = maps.size() + envelopes + lfos;
  while (program_->schedule_.size() < total) {
    const std::size_t before = program_->schedule_.size();
    for (std::size_t i = 0; i < maps.size(); ++i) {
      const PatchProgram::MapPart& map = maps[i];
      if (map_done[i] || !source_is_ready(map.source, map.source_index) ||
          !source_is_ready(map.source_v, map.source_v_index) || !all_ready(map.control_slots))
        continue;
      map_done[i] = true;
      program_->schedule_.push_back({Kind::map, static_cast<int>(i)});
    }
    for (std::size_t i = 0; i < envelopes; ++i) {
      if (envelope_done[i] || !all_ready(program_->envelopes_[i].control_slots)) continue;
      envelope_done[i] = true;
      program_->schedule_.push_back({Kind::envelope, static_cast<int>(i)});
    }
    for (std::size_t i = 0; i < lfos; ++i) {
      if (lfo_done[i] || !slot_is_ready(kSlotLfoRate + static_cast<int>(i))) continue;
      lfo_done[i] = true;
      program_->schedule_.push_back({Kind::lfo, static_cast<int>(i)});
    }
    if (program_->schedule_.size() != before) continue;
    std::string stuck;
    for (std::size_t i = 0; i < envelopes; ++i) {
      if (!envelope_done[i]) stuck += " envelope '" + program_->envelopes_[i].name + "'";
    }
    for (std::size_t i = 0; i < lfos; ++i) {
      if (!lfo_done[i]) stuck += " lfo '" + program_->lfos_[i].name + "'";
    }
    return fail(ErrorCode::cyclic_reference,
                "maps make these depend on themselves:" + (stuck.empty() ? " curves" : stuck));
  }
  return {};
}

}  // namespace knotwave::engine
