// SPDX-License-Identifier: MIT
// The sound of a voice before its loudness: oscillators, noise, crossfade, shaper, filter.
#include <algorithm>

#include "knotwave/base/elementary.h"
#include "knotwave/dsp/crossfade.h"
#include "knotwave/dsp/noise.h"

#include "map_limits.h"
#include "voice.h"

namespace knotwave::engine {
namespace {

constexpr double kSqrt2 = 0x1.6a09e667f3bcdp+0;
constexpr double kMiddleC = 60;  ///< where key tracking is neutral

void to_floats(const Signal& in, std::size_t n, std::array<float, kChunk>& out) KNOTWAVE_RT {
  if (in.is_constant()) {
    std::fill_n(out.begin(), n, static_cast<float>(in.constant));
  } else {
    for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<float>(in.values[i]);
  }
}

}  // namespace

void Voice::render_sources(std::int64_t first, std::size_t n, const Signal& pitch,
                           VoiceScratch& scratch) KNOTWAVE_RT {
  std::fill_n(scratch.mix_left.begin(), n, 0.0F);
  if (!is_mono_) std::fill_n(scratch.mix_right.begin(), n, 0.0F);
  if (patch_->spec().crossfade_on) render_crossfade(n, scratch);
  for (std::size_t i = 0; i < patch_->oscillators().size(); ++i) {
    if (patch_->oscillators()[i].gain_lin != 0) render_oscillator(i, n, pitch, scratch);
  }
  if (patch_->noise().gain_lin == 0) return;
  base::RandomStream stream = start_.note.random;
  stream.purpose = base::kRandomNoise;
  dsp::render_noise(stream, first, std::span(scratch.source_left).first(n));
  if (!is_mono_) {
    std::copy_n(scratch.source_left.begin(), n, scratch.source_right.begin());
  }
  mix_source(kNoiseSource, patch_->noise(), n, scratch);
}

void Voice::render_crossfade(std::size_t n, VoiceScratch& scratch) KNOTWAVE_RT {
  const Signal place = mapped(scratch.modulation.slots[kSlotCrossfade], n, scratch.work,
                              [&](double x) { return patch_->spec().crossfade_position + x; });
  const MovedNumbers moved = moved_numbers(patch_->crossfade_slots(), n, scratch.modulation);
  if (place.is_constant() && moved.all_constant) {
    std::array<double, curves::kMaxControls> rest;
    for (std::size_t k = 0; k < moved.count; ++k) rest[k] = moved.values[k][0];
    const dsp::GainPair gains = patch_->crossfade_law().at(
        place.constant, std::span<const double>(rest).first(moved.count));
    scratch.fade_gain_a = {static_cast<double>(gains.a), nullptr};
    scratch.fade_gain_b = {static_cast<double>(gains.b), nullptr};
    return;
  }
  const std::span<float> a = std::span(scratch.gain_left).first(n);
  const std::span<float> b = std::span(scratch.gain_right).first(n);
  if (place.is_constant()) std::fill_n(scratch.work.begin(), n, place.constant);
  const std::span<const double> places(place.is_constant() ? scratch.work.data() : place.values, n);
  patch_->crossfade_law().render(places, moved.all(), a, b);
  std::copy(a.begin(), a.end(), scratch.fade_a.begin());
  std::copy(b.begin(), b.end(), scratch.fade_b.begin());
  scratch.fade_gain_a = {0, scratch.fade_a.data()};
  scratch.fade_gain_b = {0, scratch.fade_b.data()};
}

void Voice::render_oscillator(std::size_t index, std::size_t n, const Signal& pitch,
                              VoiceScratch& scratch) KNOTWAVE_RT {
  const PatchProgram::Source& part = patch_->oscillators()[index];
  const auto& slots = scratch.modulation.slots;
  // A fixed pitch hears the maps, but neither the key nor the wheel.
  const Signal fixed = mapped(slots[kSlotPitch], n, scratch.source_pitch,
                              [&](double x) { return part.fixed_pitch + x; });
  Signal own = mapped(part.is_fixed ? fixed : pitch, n, scratch.source_pitch,
                      [&](double x) { return x + part.semitones; });
  own = sum(own, slots[kSlotSourcePitch + index], n, scratch.source_pitch);
  const auto increments = std::span(scratch.increments).first(n);
  if (own.is_constant()) {
    const double hz = base::note_to_hz(own.constant);
    std::fill(increments.begin(), increments.end(), base::phase_increment(hz, start_.rate_hz));
  } else {
    dsp::note_increments(std::span(own.values, n), start_.rate_hz, increments);
  }
  std::span<const float> positions, phases;
  if (part.tables->rows() > 1) {
    Signal place = mapped(slots[kSlotSourcePosition + index], n, scratch.work,
                          [&](double x) { return part.position + x; });
    if (part.control_slot >= 0) {
      const double range = part.control_high - part.control_low;
      const Signal number = slots[static_cast<std::size_t>(part.control_slot)];
      place = combined(place, number, n, scratch.work, [&](double x, double value) {
        return x + (value - part.control_low) / range;
      });
    }
    to_floats(place, n, scratch.control_a);
    positions = std::span(scratch.control_a).first(n);
  }
  if (part.phase_moves || start_.note.is_set(kSlotSourcePhase + static_cast<int>(index))) {
    to_floats(slots[kSlotSourcePhase + index], n, scratch.control_b);
    phases = std::span(scratch.control_b).first(n);
  }
  oscillators_[index].render(*part.tables, increments, positions, phases,
                             std::span(scratch.source_left).first(n),
                             std::span(scratch.source_right).first(is_mono_ ? 0 : n));
  mix_source(static_cast<int>(index), part, n, scratch);
}

void Voice::mix_source(int source, const PatchProgram::Source& part, std::size_t n,
                       VoiceScratch& scratch) KNOTWAVE_RT {
  const ModulationScratch& modulation = scratch.modulation;
  const auto index = static_cast<std::size_t>(source);
  const Signal level =
      limited_gain_of_db(modulation.slots[kSlotSourceLevel + index], n, scratch.work);
  Signal gain = product({part.gain_lin, nullptr}, level, n, scratch.gain);
  const Signal factor = limited_factor(modulation.slots[kSlotSourceGain + index], n, scratch.work);
  gain = product(gain, factor, n, scratch.gain);
  if (part.envelope >= 0) {
    const ChunkBuffer& envelope = modulation.envelopes[static_cast<std::size_t>(part.envelope)];
    gain = product(gain, {0, envelope.data()}, n, scratch.gain);
  }
  if (patch_->spec().crossfade_on && source == patch_->spec().crossfade_a) {
    gain = product(gain, scratch.fade_gain_a, n, scratch.gain);
  } else if (patch_->spec().crossfade_on && source == patch_->spec().crossfade_b) {
    gain = product(gain, scratch.fade_gain_b, n, scratch.gain);
  }
  gain = limited_gain(gain, n, scratch.gain);
  if (is_mono_) {
    to_floats(gain, n, scratch.gain_left);
    for (std::size_t i = 0; i < n; ++i) {
      scratch.mix_left[i] += scratch.source_left[i] * scratch.gain_left[i];
    }
    return;
  }
  const Signal pan = mapped(modulation.slots[kSlotSourcePan + index], n, scratch.pan,
                            [&](double x) { return part.pan + x; });
  if (pan.is_constant()) {
    const dsp::GainPair sides = dsp::equal_power(pan.constant);
    std::fill_n(scratch.gain_left.begin(), n, sides.a);
    std::fill_n(scratch.gain_right.begin(), n, sides.b);
  } else {
    dsp::equal_power(std::span(pan.values, n), std::span(scratch.gain_left).first(n),
                     std::span(scratch.gain_right).first(n));
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double both = gain.at(i) * kSqrt2;
    scratch.mix_left[i] += scratch.source_left[i] *
                           static_cast<float>(both * static_cast<double>(scratch.gain_left[i]));
    scratch.mix_right[i] += scratch.source_right[i] *
                            static_cast<float>(both * static_cast<double>(scratch.gain_right[i]));
  }
}

void Voice::shape(std::size_t n, VoiceScratch& scratch) KNOTWAVE_RT {
  const dsp::ShaperProgram* shaper = patch_->shaper();
  // Without any of the shaped sound, its half sample of delay and loss of treble are not heard.
  if (shaper == nullptr || patch_->spec().shaper_mix == 0) return;
  const Signal drive_db = mapped(scratch.modulation.slots[kSlotDrive], n, scratch.work,
                                 [&](double db) { return patch_->spec().shaper_drive_db + db; });
  to_floats(limited_gain_of_db(drive_db, n, scratch.work), n, scratch.control_a);
  const auto mix = static_cast<float>(patch_->spec().shaper_mix);
  const std::span<const float> drives = std::span(scratch.control_a).first(n);
  const std::span<float> left = std::span(scratch.mix_left).first(n);
  const MovedNumbers moved = moved_numbers(patch_->shaper_slots(), n, scratch.modulation);
  shaper_left_.render(*shaper, drives, moved.all(), mix, left, left);
  if (is_mono_) return;
  const std::span<float> right = std::span(scratch.mix_right).first(n);
  shaper_right_.render(*shaper, drives, moved.all(), mix, right, right);
}

void Voice::filter(std::size_t n, const Signal& key_pitch, VoiceScratch& scratch) KNOTWAVE_RT {
  const PatchSpec& spec = patch_->spec();
  if (!spec.filter_on) return;
  Signal semitones = mapped(key_pitch, n, scratch.work, [&](double pitch) {
    return spec.filter_key_track * (pitch - kMiddleC);
  });
  semitones = sum(semitones, scratch.modulation.slots[kSlotCutoff], n, scratch.work);
  const Signal octaves = mapped(semitones, n, scratch.work, [](double x) { return x / 12; });
  const Signal factor = limited_power_of_2(octaves, n, scratch.work);
  const Signal cutoff =
      mapped(factor, n, scratch.work, [&](double x) { return spec.filter_cutoff_hz * x; });
  to_floats(cutoff, n, scratch.control_a);
  const Signal resonance = mapped(scratch.modulation.slots[kSlotResonance], n, scratch.work,
                                  [&](double x) { return spec.filter_resonance + x; });
  to_floats(resonance, n, scratch.control_b);
  const std::span<const float> cutoffs = std::span(scratch.control_a).first(n);
  const std::span<const float> resonances = std::span(scratch.control_b).first(n);
  const std::span<float> left = std::span(scratch.mix_left).first(n);
  filter_left_.render(spec.filter_kind, start_.rate_hz, cutoffs, resonances, left, left);
  if (is_mono_) return;
  const std::span<float> right = std::span(scratch.mix_right).first(n);
  filter_right_.render(spec.filter_kind, start_.rate_hz, cutoffs, resonances, right, right);
}

}  // namespace knotwave::engine
