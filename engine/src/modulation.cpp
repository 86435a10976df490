// SPDX-License-Identifier: MIT
#include "modulation.h"

#include <algorithm>

#include "knotwave/base/elementary.h"

#include "map_limits.h"

namespace knotwave::engine {
namespace {

constexpr bool is_external(MapSource source) {
  return source != MapSource::envelope && source != MapSource::lfo &&
         source != MapSource::free_number;
}

int smoothing_samples(double seconds, double rate_hz) KNOTWAVE_RT {
  return static_cast<int>(std::clamp(seconds * rate_hz + 0.5, 1.0, 1e8));
}

/// A source over the chunk: an envelope, an LFO, a free number, or the player's value on its way.
Signal source_signal(MapSource source, int index, const dsp::Smoother& smoother, std::int64_t first,
                     std::size_t n, ModulationScratch& scratch, ChunkBuffer& buffer) KNOTWAVE_RT {
  const auto i = static_cast<std::size_t>(index);
  if (source == MapSource::envelope) return {0, scratch.envelopes[i].data()};
  if (source == MapSource::lfo) return {0, scratch.lfos[i].data()};
  if (source == MapSource::free_number) {
    return mapped(scratch.slots[kSlotFree + i], n, buffer, limited_free);
  }
  if (smoother.is_still(first)) return {smoother.target(), nullptr};
  smoother.render(first, std::span(buffer).first(n));
  return {0, buffer.data()};
}

Signal through_curve(const PatchProgram::MapPart& map, const Signal& u, std::size_t n,
                     curves::CurveCursor& cursor, ModulationScratch& scratch) KNOTWAVE_RT {
  const MovedNumbers moved = moved_numbers(map.control_slots, n, scratch);
  if (u.is_constant() && moved.all_constant) {
    std::array<double, curves::kMaxControls> rest;
    for (std::size_t k = 0; k < moved.count; ++k) rest[k] = moved.values[k][0];
    return {map.curve->at_u(u.constant, 0, std::span(rest).first(moved.count)), nullptr};
  }
  ChunkBuffer& places = scratch.source;
  if (u.is_constant()) std::fill_n(places.begin(), n, u.constant);
  const std::span<const double> at(u.is_constant() ? places.data() : u.values, n);
  const std::span<double> out = std::span(scratch.shaped).first(n);
  if (moved.count == 0) {
    map.curve->render(at, out, cursor);
  } else {
    map.curve->render(at, moved.all(), out, cursor);
  }
  return {0, scratch.shaped.data()};
}

Signal over_surface(const curves::SurfaceProgram& surface, const Signal& u, const Signal& v,
                    std::size_t n, ModulationScratch& scratch) KNOTWAVE_RT {
  if (u.is_constant() && v.is_constant()) return {surface.at(u.constant, v.constant), nullptr};
  if (u.is_constant()) std::fill_n(scratch.source.begin(), n, u.constant);
  const std::span<const double> along_u(u.is_constant() ? scratch.source.data() : u.values, n);
  const std::span<double> out = std::span(scratch.shaped).first(n);
  if (v.is_constant()) {
    surface.render_row(along_u, v.constant, out);
  } else {
    surface.render_path(along_u, std::span(v.values, n), out);
  }
  return {0, scratch.shaped.data()};
}

/// What set_target events say, before any map.
void add_targets(const SlotTargets* targets, std::int64_t first, std::size_t n,
                 ModulationScratch& scratch) KNOTWAVE_RT {
  if (targets == nullptr) return;
  for (std::size_t i = 0; i < targets->slots().size(); ++i) {
    const std::uint8_t slot = targets->slots()[i];
    const dsp::Smoother& number = targets->number(i);
    Signal value{number.target(), nullptr};
    if (!number.is_still(first)) {
      number.render(first, std::span(scratch.source).first(n));
      value.values = scratch.source.data();
    }
    scratch.slots[slot] = sum(scratch.slots[slot], value, n, scratch.slot_values[slot]);
  }
}

void add(ModulationScratch& scratch, int slot, const Signal& value, std::size_t n) KNOTWAVE_RT {
  const auto i = static_cast<std::size_t>(slot);
  scratch.slots[i] = sum(scratch.slots[i], value, n, scratch.slot_values[i]);
}

}  // namespace

MovedNumbers moved_numbers(std::span<const int> slots, std::size_t n,
                           ModulationScratch& scratch) KNOTWAVE_RT {
  MovedNumbers moved;
  for (const int slot : slots) {
    if (moved.count == moved.values.size()) break;
    const Signal& number = scratch.slots[static_cast<std::size_t>(slot)];
    ChunkBuffer& buffer = scratch.controls[moved.count];
    if (number.is_constant()) std::fill_n(buffer.begin(), n, number.constant);
    moved.values[moved.count++] = number.is_constant() ? buffer.data() : number.values;
    moved.all_constant = moved.all_constant && number.is_constant();
  }
  return moved;
}

void Modulation::start(const PatchProgram& patch, const NoteContext& note, base::SampleTime time,
                       double rate_hz, const TempoClock& tempo) KNOTWAVE_RT {
  const auto maps = patch.maps();
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const PatchProgram::MapPart& map = maps[i];
    const int samples = smoothing_samples(map.smooth_s, rate_hz);
    players_[i].source.reset(source_value(note, map.source, map.source_index), samples);
    players_[i].source_v.reset(source_value(note, map.source_v, map.source_v_index), samples);
    players_[i].cursor = {};
  }
  for (std::size_t i = 0; i < patch.envelopes().size(); ++i) envelopes_[i].reset();
  limited_joins_seen_ = 0;
  song_moves_seen_ = tempo.moves();
  for (std::size_t i = 0; i < patch.lfos().size(); ++i) {
    const dsp::LfoSpec& spec = patch.lfos()[i].spec;
    base::RandomStream stream = note.random;
    stream.purpose = base::kRandomLfo | static_cast<std::uint32_t>(i << 8);
    if (spec.mode == dsp::LfoSpec::Mode::free) stream.voice = 0;  // all voices agree
    lfos_[i].start(spec, time, rate_hz, stream);
  }
  open_gates(patch, note, time, rate_hz, tempo);
}

void Modulation::retrigger(const PatchProgram& patch, const NoteContext& note,
                           base::SampleTime time, double rate_hz,
                           const TempoClock& tempo) KNOTWAVE_RT {
  follow(patch, note, base::first_sample(time));
  open_gates(patch, note, time, rate_hz, tempo);
}

double Modulation::value_at_note_on(const PatchProgram::MapPart& map, const Player& player,
                                    const SlotNumbers& slots) KNOTWAVE_RT {
  const auto now = [&](MapSource source, int index, const dsp::Smoother& smoother) {
    if (source != MapSource::free_number) return smoother.target();
    return limited_free(slots[static_cast<std::size_t>(kSlotFree + index)]);
  };
  double value = now(map.source, map.source_index, player.source);
  if (map.curve) {
    std::array<double, curves::kMaxControls> controls{};
    const std::size_t count = map.control_slots.size();
    for (std::size_t k = 0; k < count; ++k) {
      controls[k] = slots[static_cast<std::size_t>(map.control_slots[k])];
    }
    value = map.curve->at_u(value, 0, std::span<const double>(controls).first(count));
  }
  if (map.surface) {
    const double v = now(map.source_v, map.source_v_index, player.source_v);
    value = map.surface->at(value, v);
  }
  value *= map.depth;
  if (!map.is_control) return value;
  return map.low + (map.high - map.low) * std::clamp(value, 0.0, 1.0);
}

// What the maps come to that envelopes' times hang on, of the player's present values alone.
Modulation::SlotNumbers Modulation::numbers_at_note_on(const PatchProgram& patch,
                                                       const NoteContext& note) const KNOTWAVE_RT {
  SlotNumbers slots{};
  for (const SlotTargets* targets : note.targets) {
    if (targets == nullptr) continue;
    for (std::size_t i = 0; i < targets->slots().size(); ++i) {
      slots[targets->slots()[i]] += targets->number(i).target();
    }
  }
  for (const int index : patch.note_on_maps()) {
    const auto i = static_cast<std::size_t>(index);
    const PatchProgram::MapPart& map = patch.maps()[i];
    double& slot = slots[static_cast<std::size_t>(map.slot)];
    const double value = value_at_note_on(map, players_[i], slots);
    slot = map.is_control ? std::clamp(value + slot, map.low, map.high) : slot + value;
  }
  return slots;
}

void Modulation::open_gates(const PatchProgram& patch, const NoteContext& note,
                            base::SampleTime time, double rate_hz,
                            const TempoClock& tempo) KNOTWAVE_RT {
  const SlotNumbers slots = numbers_at_note_on(patch, note);
  for (std::size_t i = 0; i < patch.envelopes().size(); ++i) {
    const PatchProgram::EnvelopePart& part = patch.envelopes()[i];
    const double octaves = part.velocity_time * (127 - note.velocity) / 126.0 +
                           part.key_time * (60 - note.note) / 12 + slots[kSlotEnvelopeTime + i];
    const double unit_s = part.tempo_beats ? tempo.seconds_per_quarter() : 1;
    envelopes_[i].gate_on(part.program, time, rate_hz, unit_s * base::exp2(octaves));
  }
}

void Modulation::release(const PatchProgram& patch, base::SampleTime time) KNOTWAVE_RT {
  for (std::size_t i = 0; i < patch.envelopes().size(); ++i) {
    envelopes_[i].gate_off(patch.envelopes()[i].program, time);
  }
}

void Modulation::follow(const PatchProgram& patch, const NoteContext& note,
                        std::int64_t sample) KNOTWAVE_RT {
  for (std::size_t i = 0; i < patch.maps().size(); ++i) {
    const PatchProgram::MapPart& map = patch.maps()[i];
    Player& player = players_[i];
    if (is_external(map.source)) {
      player.source.set_target(source_value(note, map.source, map.source_index), sample);
    }
    if (map.surface && is_external(map.source_v)) {
      player.source_v.set_target(source_value(note, map.source_v, map.source_v_index), sample);
    }
  }
}

// Free LFOs are where the song is; the others count from their note.
void Modulation::follow_song(const PatchProgram& patch, const TempoClock& tempo) KNOTWAVE_RT {
  if (song_moves_seen_ == tempo.moves()) return;
  song_moves_seen_ = tempo.moves();
  for (std::size_t i = 0; i < patch.lfos().size(); ++i) {
    const dsp::LfoSpec& spec = patch.lfos()[i].spec;
    if (spec.beats > 0 && spec.mode == dsp::LfoSpec::Mode::free) lfos_[i].song_moved();
  }
}

void Modulation::render(const PatchProgram& patch, const NoteContext& note, const TempoClock& tempo,
                        std::int64_t first, std::size_t n, ModulationScratch& scratch) KNOTWAVE_RT {
  follow_song(patch, tempo);
  scratch.slots.fill({});
  if (note.has_targets()) {
    for (const SlotTargets* targets : note.targets) add_targets(targets, first, n, scratch);
  }
  for (const PatchProgram::Step& step : patch.schedule()) {
    const auto index = static_cast<std::size_t>(step.index);
    switch (step.kind) {
      case PatchProgram::Step::Kind::map:
        render_map(patch, note, index, first, n, scratch);
        break;
      case PatchProgram::Step::Kind::envelope:
        render_envelope(patch, index, first, n, scratch);
        break;
      case PatchProgram::Step::Kind::lfo:
        render_lfo(patch, note, index, tempo, first, n, scratch);
        break;
    }
  }
}

void Modulation::render_map(const PatchProgram& patch, const NoteContext& note, std::size_t index,
                            std::int64_t first, std::size_t n,
                            ModulationScratch& scratch) KNOTWAVE_RT {
  const PatchProgram::MapPart& map = patch.maps()[index];
  Player& player = players_[index];
  Signal value =
      source_signal(map.source, map.source_index, player.source, first, n, scratch, scratch.source);
  if (map.curve) {
    value = through_curve(map, value, n, player.cursor, scratch);
  } else if (map.surface) {
    const Signal v = source_signal(map.source_v, map.source_v_index, player.source_v, first, n,
                                   scratch, scratch.source_v);
    value = over_surface(*map.surface, value, v, n, scratch);
  }
  value = mapped(value, n, scratch.shaped, [&](double x) { return map.depth * x; });
  if (map.is_control) {
    value = mapped(value, n, scratch.shaped, [&](double x) {
      return map.low + (map.high - map.low) * std::clamp(x, 0.0, 1.0);
    });
    if (note.is_set(map.slot)) {  // a moved number never leaves its range
      Signal& slot = scratch.slots[static_cast<std::size_t>(map.slot)];
      value = combined(value, slot, n, scratch.shaped, [&](double x, double set) {
        return std::clamp(x + set, map.low, map.high);
      });
      slot = {};
    }
  }
  add(scratch, map.slot, value, n);
}

void Modulation::render_envelope(const PatchProgram& patch, std::size_t index, std::int64_t first,
                                 std::size_t n, ModulationScratch& scratch) KNOTWAVE_RT {
  const PatchProgram::EnvelopePart& part = patch.envelopes()[index];
  const MovedNumbers moved = moved_numbers(part.control_slots, n, scratch);
  envelopes_[index].render(part.program, first, moved.all(),
                           std::span(scratch.envelopes[index]).first(n));
}

void Modulation::render_lfo(const PatchProgram& patch, const NoteContext& note, std::size_t index,
                            const TempoClock& tempo, std::int64_t first, std::size_t n,
                            ModulationScratch& scratch) KNOTWAVE_RT {
  const PatchProgram::LfoPart& part = patch.lfos()[index];
  std::span<const double> rate_factor, beats;
  if (part.rate_moves || note.is_set(kSlotLfoRate + static_cast<int>(index))) {
    const Signal factor =
        limited_power_of_2(scratch.slots[kSlotLfoRate + index], n, scratch.source);
    if (factor.is_constant()) std::fill_n(scratch.source.begin(), n, factor.constant);
    rate_factor = std::span(scratch.source).first(n);
  }
  if (part.spec.beats > 0) {
    const bool is_free = part.spec.mode == dsp::LfoSpec::Mode::free;
    for (std::size_t i = 0; i < n; ++i) {
      const std::int64_t sample = first + static_cast<std::int64_t>(i);
      scratch.beats[i] = is_free ? tempo.beats_at(sample) : tempo.played_at(sample);
    }
    beats = std::span(scratch.beats).first(n);
  }
  const MovedNumbers moved = moved_numbers(part.control_slots, n, scratch);
  lfos_[index].render(part.spec, part.cycle, first, rate_factor, beats, moved.all(),
                      std::span(scratch.lfos[index]).first(n));
}

void Modulation::look_ahead_from(const Modulation& other, const PatchProgram& patch) KNOTWAVE_RT {
  const auto copy = [](const auto& from, std::size_t count, auto& to) {
    std::copy_n(from.begin(), count, to.begin());
  };
  copy(other.envelopes_, patch.envelopes().size(), envelopes_);
  copy(other.lfos_, patch.lfos().size(), lfos_);
  copy(other.players_, patch.maps().size(), players_);
  limited_joins_seen_ = other.limited_joins_seen_;
  song_moves_seen_ = other.song_moves_seen_;
}

bool Modulation::is_still(const PatchProgram& patch, std::int64_t first) const KNOTWAVE_RT {
  for (std::size_t i = 0; i < patch.envelopes().size(); ++i) {
    if (!envelopes_[i].is_idle()) return false;
  }
  for (std::size_t i = 0; i < patch.maps().size(); ++i) {
    if (!players_[i].source.is_still(first) || !players_[i].source_v.is_still(first)) return false;
  }
  return true;
}

int Modulation::take_limited_joins(const PatchProgram& patch) KNOTWAVE_RT {
  int total = 0;
  for (std::size_t i = 0; i < patch.envelopes().size(); ++i) {
    total += envelopes_[i].limited_joins();
  }
  const int fresh = total - limited_joins_seen_;
  limited_joins_seen_ = total;
  return std::max(fresh, 0);
}

}  // namespace knotwave::engine
