// SPDX-License-Identifier: MIT
// Maps of a patch: what they read, which numbers of curves they move, where they add.
#include <algorithm>
#include <array>
#include <utility>

#include "knotwave/base/document.h"
#include "knotwave/base/suggest.h"

#include "map_schedule.h"
#include "patch_compiler.h"
#include "patch_words.h"

namespace knotwave::engine {
namespace {

constexpr curves::ControlRange::Kind kind_of(MapTarget target) {
  using Kind = curves::ControlRange::Kind;
  return target == MapTarget::curve_weight ? Kind::weight
         : target == MapTarget::curve_knot ? Kind::knot
                                           : Kind::coordinate;
}

constexpr bool varies_by_itself(MapSource source) {
  return source == MapSource::envelope || source == MapSource::lfo;
}

constexpr bool moves_sound(MapTarget target) {
  return target != MapTarget::free_number && target != MapTarget::envelope_time &&
         target != MapTarget::lfo_rate && target != MapTarget::curve_weight &&
         target != MapTarget::curve_point && target != MapTarget::curve_knot;
}

Result<void> check_index(const char* what, int index, std::size_t count) {
  if (index >= 0 && static_cast<std::size_t>(index) < count) return {};
  return fail(ErrorCode::value_out_of_range, std::string(what) + " " + std::to_string(index) +
                                                 " does not exist; there are " +
                                                 std::to_string(count));
}

}  // namespace

// Messages count maps from 1, paths from 0.
PatchCompiler::Part PatchCompiler::map_part(int number, const char* key) const {
  return {"map " + std::to_string(number + 1), "maps." + std::to_string(number) + key};
}

Result<void> PatchCompiler::check_range(const MovedNumber& moved) const {
  if (moved.range.kind == curves::ControlRange::Kind::knot) return check_knot(moved);
  const curves::NurbsCurve* found = spec_.curves.find_curve(moved.curve);
  const curves::CurveSpec written = found->spec();
  const auto point = static_cast<std::size_t>(moved.range.point);
  const auto dim = static_cast<std::size_t>(written.dim);
  const auto coordinate = static_cast<std::size_t>(moved.range.coordinate);
  if (moved.range.point < 0 || moved.range.coordinate < 0 || coordinate >= dim ||
      (point + 1) * dim > written.points.size())
    return {};  // compiling the curve says so
  const bool is_weight = moved.range.kind == curves::ControlRange::Kind::weight;
  const double rest = !is_weight                ? written.points[point * dim + coordinate]
                      : written.weights.empty() ? 1
                                                : written.weights[point];
  if (rest >= moved.range.low && rest <= moved.range.high) return {};
  return about(
      fail(ErrorCode::value_out_of_range,
           "low (" + base::number_text(moved.range.low) + ") to high (" +
               base::number_text(moved.range.high) + ") leaves out " + base::number_text(rest) +
               ", which " + (is_weight ? "weight " : "point ") + std::to_string(moved.range.point) +
               " of curve '" + moved.curve + "' has in the file"),
      map_part(moved.map, rest < moved.range.low ? ".low" : ".high"));
}

// Against its neighbours too, and against the knots that earlier maps move.
Result<void> PatchCompiler::check_knot(const MovedNumber& moved) const {
  std::vector<curves::ControlRange> knots{moved.range};
  for (const MovedNumber& other : moved_) {
    const bool is_knot = other.range.kind == curves::ControlRange::Kind::knot;
    // The same knot twice is told as a conflict of two maps.
    if (!is_knot || other.curve != moved.curve || other.range.point == moved.range.point) continue;
    knots.push_back(other.range);
  }
  auto ok = curves::check_controls(*spec_.curves.find_curve(moved.curve), knots);
  return ok ? ok : about(ok.error(), map_part(moved.map, ".low"));
}

Result<void> PatchCompiler::collect_moved_numbers() {
  for (std::size_t i = 0; i < spec_.maps.size(); ++i) {
    const MapSpec& map = spec_.maps[i];
    if (!map.enabled || !moves_a_number(map)) continue;
    MovedNumber moved;
    moved.curve = map.target_curve;
    moved.map = static_cast<int>(i);
    moved.range.kind = kind_of(map.target);
    moved.range.point = map.target_point;
    moved.range.coordinate = map.target == MapTarget::curve_point ? map.target_coordinate : 0;
    moved.range.low = map.low;
    moved.range.high = map.high;
    const Part part = map_part(moved.map, ".to");
    if (auto found = curve(moved.curve, part); !found) return found.error();
    if (auto ok = check_range(moved); !ok) return ok;
    for (const MovedNumber& other : moved_) {
      if (other.curve != moved.curve || other.range.kind != moved.range.kind ||
          other.range.point != moved.range.point ||
          other.range.coordinate != moved.range.coordinate)
        continue;
      return placed(
          fail(ErrorCode::control_conflict,
               map_part(other.map).name + " and " + part.name + " move the same number of curve '" +
                   moved.curve + "' (point " + std::to_string(moved.range.point) + ")"),
          part.path);
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
    if (auto done = compile_map(spec_.maps[i], i); !done)
      return about(done.error(), map_part(static_cast<int>(i)));
  }
  drop_overridden_maps();
  return {};
}

bool PatchCompiler::is_rational(const MapSpec& map) const {
  if (!map.surface.empty()) return spec_.curves.find_surface(map.surface)->is_rational();
  if (map.curve.empty()) return false;
  const std::vector<int> moved = moved_numbers_of(map.curve);
  return spec_.curves.find_curve(map.curve)->is_rational() ||
         std::any_of(moved.begin(), moved.end(), [&](int number) {
           const auto kind = moved_[static_cast<std::size_t>(number)].range.kind;
           return kind == curves::ControlRange::Kind::weight;
         });
}

// A rational map overrides the plain ones onto its target. They are not compiled in, so that they
// cost nothing, like those that are off.
void PatchCompiler::drop_overridden_maps() {
  std::array<int, kSlotCount> rational_map;
  rational_map.fill(-1);
  for (std::size_t i = 0; i < program_->maps_.size(); ++i) {
    int& first = rational_map[static_cast<std::size_t>(program_->maps_[i].slot)];
    if (first < 0 && map_origins_[i].is_rational) first = map_origins_[i].number;
  }
  std::vector<PatchProgram::MapPart> kept;
  std::vector<MapOrigin> kept_origins;
  for (std::size_t i = 0; i < program_->maps_.size(); ++i) {
    const int by = rational_map[static_cast<std::size_t>(program_->maps_[i].slot)];
    if (by < 0 || map_origins_[i].is_rational) {
      kept.push_back(std::move(program_->maps_[i]));
      kept_origins.push_back(map_origins_[i]);
      continue;
    }
    tell(map_part(map_origins_[i].number).name + " is overridden: " + map_part(by).name +
         " moves the same target by a rational curve or surface");
  }
  program_->maps_ = std::move(kept);
  map_origins_ = std::move(kept_origins);
}

Result<void> PatchCompiler::check_source(MapSource source, int index) const {
  const std::size_t count = source == MapSource::envelope      ? spec_.envelopes.size()
                            : source == MapSource::lfo         ? spec_.lfos.size()
                            : source == MapSource::free_number ? spec_.free_numbers.size()
                                                               : 128;
  return check_index("source", index, count);
}

Result<void> PatchCompiler::check_target(const MapSpec& map) const {
  const int index = map.target_index;
  const bool is_voice = index < 0, is_noise = index == kNoiseSource;
  const auto oscillator = [&] {
    return check_index("oscillator", index, spec_.oscillators.size());
  };
  if (!spec_.has_sound && moves_sound(map.target)) {
    return fail(ErrorCode::unsupported, "an envelope patch has no sound that a map could move");
  }
  switch (map.target) {
    case MapTarget::level:
      return is_noise ? Result<void>{} : oscillator();
    case MapTarget::gain:
    case MapTarget::pan:
      return is_voice || is_noise ? Result<void>{} : oscillator();
    case MapTarget::pitch:
      return is_voice ? Result<void>{} : oscillator();
    case MapTarget::phase:
    case MapTarget::position:
      return oscillator();
    case MapTarget::lfo_rate:
      return check_index("lfo", index, spec_.lfos.size());
    case MapTarget::envelope_time:
      return check_index("envelope", index, spec_.envelopes.size());
    case MapTarget::free_number:
      return check_index("free number", index, spec_.free_numbers.size());
    default:
      return {};
  }
}

Result<void> PatchCompiler::check_map(const MapSpec& map, std::size_t number) const {
  const std::string path = "maps." + std::to_string(number);
  for (const auto& [source, index] :
       {std::pair(map.source, map.source_index), std::pair(map.source_v, map.source_v_index)}) {
    if (auto ok = check_source(source, index); !ok) return placed(ok.error(), path + ".from");
  }
  if (auto ok = check_target(map); !ok) return placed(ok.error(), path + ".to");
  return {};
}

Result<void> PatchCompiler::add_curve(const MapSpec& map, std::size_t number,
                                      PatchProgram::MapPart& part) const {
  const std::string path = "maps." + std::to_string(number) + ".curve";
  auto found = moved_curve(map.curve, {"its curve", path});
  if (!found) return found.error();
  part.control_slots = found->slots;
  auto program = curves::compile_function(*found->curve, found->options);
  if (!program) return placed(program.error(), path);
  part.curve = *std::move(program);
  return {};
}

Result<void> PatchCompiler::add_surface(const MapSpec& map, PatchProgram::MapPart& part) const {
  const curves::NurbsSurface* surface = spec_.curves.find_surface(map.surface);
  if (surface == nullptr) {
    const auto names = spec_.curves.names();
    return fail(ErrorCode::unknown_name,
                "no surface '" + map.surface + "'" + base::suggestion(map.surface, names));
  }
  if (surface->dim() != 1) {
    return fail(ErrorCode::not_scalar, "surface '" + map.surface + "' has " +
                                           std::to_string(surface->dim()) +
                                           " coordinates; a map needs 1");
  }
  part.source_v = map.source_v;
  part.source_v_index = map.source_v_index;
  auto program = curves::compile_surface(*surface);
  if (!program) return std::move(program).error();
  part.surface = *std::move(program);
  return {};
}

Result<void> PatchCompiler::compile_map(const MapSpec& map, std::size_t number) {
  if (auto ok = check_map(map, number); !ok) return ok;
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
    if (auto done = add_curve(map, number, part); !done) return done;
  } else if (!map.surface.empty()) {
    if (auto done = add_surface(map, part); !done)
      return placed(done.error(), "maps." + std::to_string(number) + ".surface");
  }
  program_->maps_.push_back(std::move(part));
  map_origins_.push_back({static_cast<int>(number), is_rational(map)});
  return {};
}

Result<void> PatchCompiler::order_steps() {
  Schedule schedule = make_schedule(program_->maps_, program_->envelopes_, program_->lfos_);
  if (!schedule.stuck.empty()) return circle(schedule.stuck);
  program_->schedule_ = std::move(schedule.steps);
  return find_note_on_maps();
}

Error PatchCompiler::circle(const std::vector<PatchProgram::Step>& stuck) const {
  using Kind = PatchProgram::Step::Kind;
  std::vector<std::string> names;
  const PatchProgram::Step* closing = nullptr;  // a circle always has a map
  for (const PatchProgram::Step& step : stuck) {
    const auto index = static_cast<std::size_t>(step.index);
    std::string name;
    if (step.kind == Kind::envelope) name = "envelope '" + program_->envelopes_[index].name + "'";
    if (step.kind == Kind::lfo) name = "lfo '" + program_->lfos_[index].name + "'";
    if (step.kind == Kind::map) {
      if (closing == nullptr) closing = &step;
      const int slot = program_->maps_[index].slot;
      if (!is_free_slot(slot)) continue;
      name = "free." + spec_.free_numbers[static_cast<std::size_t>(slot - kSlotFree)];
    }
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  if (names.empty()) names.emplace_back("curves of maps");
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? " " : ", ") + name;
  const auto map = static_cast<std::size_t>(closing->index);
  return placed(fail(ErrorCode::cyclic_reference, "maps make these depend on themselves:" + all),
                map_part(map_origins_[map].number, ".to").path);
}

// Backwards from the envelopes' times, which are read once.
Result<void> PatchCompiler::find_note_on_maps() {
  std::array<bool, kSlotCount> is_read{};
  std::fill_n(is_read.begin() + kSlotEnvelopeTime, kMaxVoiceEnvelopes, true);
  std::vector<int>& found = program_->note_on_maps_;
  const auto& schedule = program_->schedule_;
  for (auto step = schedule.rbegin(); step != schedule.rend(); ++step) {
    if (step->kind != PatchProgram::Step::Kind::map) continue;
    const auto index = static_cast<std::size_t>(step->index);
    const PatchProgram::MapPart& map = program_->maps_[index];
    if (!is_read[static_cast<std::size_t>(map.slot)]) continue;
    if (varies_by_itself(map.source) || varies_by_itself(map.source_v)) {
      return about(fail(ErrorCode::unsupported,
                        "an envelope's time is read once, when a note starts; an envelope or LFO "
                        "cannot move it"),
                   map_part(map_origins_[index].number, ".from"));
    }
    for (const int slot : slots_read_by(map)) is_read[static_cast<std::size_t>(slot)] = true;
    found.push_back(step->index);
  }
  std::reverse(found.begin(), found.end());
  return {};
}

}  // namespace knotwave::engine
