// SPDX-License-Identifier: MIT
// The life of a voice, its pitch and its loudness. Its sound is in voice_sources.cpp.
#include "voice.h"

#include <algorithm>

#include "knotwave/base/elementary.h"

#include "map_limits.h"

namespace knotwave::engine {
namespace {

int samples_of(double seconds, double rate_hz) KNOTWAVE_RT {
  return static_cast<int>(std::clamp(seconds * rate_hz + 0.5, 1.0, 1e8));
}

/// Samples of the chunk until `envelope`, as it was before the chunk, comes to rest.
std::size_t samples_until_idle(const dsp::Envelope& envelope, const dsp::EnvelopeProgram& program,
                               std::int64_t first, std::size_t n) KNOTWAVE_RT {
  ChunkBuffer ignored;
  std::size_t low = 1, high = n;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    dsp::Envelope copy = envelope;
    copy.render(program, first, {}, std::span(ignored).first(middle));
    (copy.is_idle() ? high : low) = copy.is_idle() ? middle : middle + 1;
  }
  return high;
}

}  // namespace

double Voice::velocity_gain() const KNOTWAVE_RT {
  if (!patch_->uses_velocity_law()) return 1;
  return base::db_to_gain(-patch_->spec().velocity_db * (127 - start_.note.velocity) / 126.0);
}

double Voice::key_pitch_of_note() const KNOTWAVE_RT {
  return patch_->tuning().midi_pitch(start_.note.note);
}

double Voice::envelope_place(std::int64_t sample) const KNOTWAVE_RT {
  const int amp = patch_->amp_envelope();
  return modulation_.envelope(amp).place_at(
      patch_->envelopes()[static_cast<std::size_t>(amp)].program, sample);
}

bool Voice::may_end_by(std::int64_t sample) const KNOTWAVE_RT {
  if (fade_.is_over(sample)) return true;
  const int index = patch_->amp_envelope();
  const dsp::EnvelopeProgram& program =
      patch_->envelopes()[static_cast<std::size_t>(index)].program;
  const dsp::Envelope& amp = modulation_.envelope(index);
  const bool holds = amp.gate_is_open() && (program.has_sustain() || program.has_loop());
  return !holds && amp.place_at(program, sample) >= 1;
}

void Voice::start(const Start& start, const TempoClock& tempo) KNOTWAVE_RT {
  start_ = start;
  patch_ = start.patch;
  done_ = false;
  detached_ = false;
  level_ = 0;
  fade_.reset();
  static_gain_ = patch_->gain_lin() * start.gain_lin * base::db_to_gain(kVoiceHeadroomDb);
  if (start.note.master->soft() || start.note.channel->soft()) {
    static_gain_ *= base::db_to_gain(kSoftPedalDb);
  }
  const double pitch = key_pitch_of_note();
  glide_.reset(start.portamento.from.value_or(pitch));
  glide_.start(patch_->glide_curve(), pitch, start.time, start.portamento.seconds, start.rate_hz);
  bend_.reset(bend_semitones(start.note, patch_->spec().bend_semitones),
              samples_of(kBendGlideSeconds, start.rate_hz));
  velocity_gain_.reset(velocity_gain(), samples_of(kVelocityGlideSeconds, start.rate_hz));
  modulation_.start(*patch_, start.note, start.time, start.rate_hz, tempo);
  const double lead =
      std::min(base::samples_since(start.time, base::first_sample(start.time)), 1 - 0x1p-32);
  for (std::size_t i = 0; i < patch_->oscillators().size(); ++i) {
    const PatchProgram::Source& source = patch_->oscillators()[i];
    double phase = source.phase_cycles;
    if (source.random_phase) {
      base::RandomStream stream = start.note.random;
      stream.purpose = base::kRandomPhase;
      phase += stream.unit(i);
    }
    oscillators_[i].start(base::phase_from_cycles(phase), lead);
  }
  shaper_left_.reset();
  shaper_right_.reset();
  filter_left_.reset();
  filter_right_.reset();
  is_mono_ = patch_->is_mono();
}

void Voice::play(const NoteContext& note, base::SampleTime time, bool joins,
                 const Portamento& portamento, const TempoClock& tempo) KNOTWAVE_RT {
  const std::int64_t sample = base::first_sample(time);
  const int velocity = joins ? note.velocity : start_.note.velocity;
  const base::RandomStream random = start_.note.random;
  start_.note = note;
  start_.note.velocity = velocity;
  start_.note.random = random;
  if (portamento.from) glide_.reset(*portamento.from);
  glide_.start(patch_->glide_curve(), key_pitch_of_note(), time, portamento.seconds,
               start_.rate_hz);
  detached_ = false;
  if (!joins) return;
  velocity_gain_.set_target(velocity_gain(), sample);
  modulation_.retrigger(*patch_, start_.note, time, start_.rate_hz, tempo);
}

void Voice::release(base::SampleTime time, int velocity) KNOTWAVE_RT {
  start_.note.release_velocity = velocity;
  modulation_.release(*patch_, time);
}

void Voice::fade_out(std::int64_t sample, double seconds) KNOTWAVE_RT {
  fade_.begin_out(sample, samples_of(seconds, start_.rate_hz));
}

void Voice::fade_in(std::int64_t sample, double seconds) KNOTWAVE_RT {
  fade_.begin_in(sample, samples_of(seconds, start_.rate_hz));
}

void Voice::render(std::int64_t first, const TempoClock& tempo, VoiceScratch& scratch,
                   std::span<float> left, std::span<float> right) KNOTWAVE_RT {
  if (!detached_) {
    modulation_.follow(*patch_, start_.note, first);
    bend_.set_target(bend_semitones(start_.note, patch_->spec().bend_semitones), first);
  }
  std::size_t at = 0;
  for (; at < left.size() && !done_; at += std::min(kChunk, left.size() - at)) {
    const std::size_t n = std::min(kChunk, left.size() - at);
    render_chunk(first + static_cast<std::int64_t>(at), n, tempo, scratch, left.data() + at,
                 right.data() + at);
  }
  std::fill(left.begin() + static_cast<std::ptrdiff_t>(at), left.end(), 0.0F);
  std::fill(right.begin() + static_cast<std::ptrdiff_t>(at), right.end(), 0.0F);
}

void Voice::render_chunk(std::int64_t first, std::size_t n, const TempoClock& tempo,
                         VoiceScratch& scratch, float* left, float* right) KNOTWAVE_RT {
  const dsp::Envelope amp_before = modulation_.envelope(patch_->amp_envelope());
  modulation_.render(*patch_, start_.note, tempo, first, n, scratch.modulation);
  if (is_mono_ && start_.note.has_targets()) widen_if_panned();
  end_if_silent(amp_before, first, n);
  Signal key_pitch, pitch;
  render_pitch(first, n, scratch, key_pitch, pitch);
  render_sources(first, n, pitch, scratch);
  shape(n, scratch);
  filter(n, key_pitch, scratch);
  render_amp(first, n, scratch);
  for (std::size_t i = 0; i < n; ++i) {
    const float to_right = is_mono_ ? scratch.mix_left[i] : scratch.mix_right[i];
    left[i] = scratch.mix_left[i] * scratch.gain_left[i];
    right[i] = to_right * scratch.gain_right[i];
  }
}

// No map pans a source, so that the patch was compiled as mono; a set_target event does. From here
// on the right side is a second one, begun where the left one is.
void Voice::widen_if_panned() KNOTWAVE_RT {
  for (int source = 0; source < kMaxSources; ++source) {
    if (start_.note.is_set(kSlotSourcePan + source)) is_mono_ = false;
  }
  if (is_mono_) return;
  shaper_right_ = shaper_left_;
  filter_right_ = filter_left_;
}

void Voice::render_pitch(std::int64_t first, std::size_t n, VoiceScratch& scratch,
                         Signal& key_pitch, Signal& pitch) KNOTWAVE_RT {
  key_pitch = {glide_.target(), nullptr};
  if (!glide_.is_still(first)) {
    const MovedNumbers moved = moved_numbers(patch_->glide_slots(), n, scratch.modulation);
    glide_.render(patch_->glide_curve(), first, moved.all(), std::span(scratch.glide).first(n));
    key_pitch.values = scratch.glide.data();
  }
  Signal bend{bend_.target(), nullptr};
  if (!bend_.is_still(first)) {
    bend_.render(first, std::span(scratch.bend).first(n));
    bend.values = scratch.bend.data();
  }
  pitch = sum(key_pitch, bend, n, scratch.pitch);
  pitch = sum(pitch, scratch.modulation.slots[kSlotPitch], n, scratch.pitch);
}

void Voice::render_amp(std::int64_t first, std::size_t n, VoiceScratch& scratch) KNOTWAVE_RT {
  const ModulationScratch& modulation = scratch.modulation;
  const auto amp_index = static_cast<std::size_t>(patch_->amp_envelope());
  Signal gain{static_gain_, nullptr};
  Signal velocity{velocity_gain_.target(), nullptr};
  if (!velocity_gain_.is_still(first)) {
    velocity_gain_.render(first, std::span(scratch.work).first(n));
    velocity.values = scratch.work.data();
  }
  gain = product(gain, velocity, n, scratch.amp);
  const Signal level = limited_gain_of_db(modulation.slots[kSlotAmp], n, scratch.work);
  gain = product(gain, level, n, scratch.amp);
  const Signal factor = limited_factor(modulation.slots[kSlotGain], n, scratch.work);
  gain = product(gain, factor, n, scratch.amp);
  gain = product(gain, {0, modulation.envelopes[amp_index].data()}, n, scratch.amp);
  gain = limited_gain(gain, n, scratch.amp);
  if (fade_.is_moving(first)) {
    for (std::size_t i = 0; i < n; ++i) {
      scratch.amp[i] *= fade_.at(first + static_cast<std::int64_t>(i));
    }
  }
  level_ = gain.at(n - 1);
  const Signal pan = mapped(modulation.slots[kSlotPan], n, scratch.pan,
                            [&](double x) { return patch_->spec().pan + x; });
  if (pan.is_constant()) {
    const dsp::GainPair sides = dsp::equal_power(pan.constant);
    std::fill_n(scratch.gain_left.begin(), n, sides.a);
    std::fill_n(scratch.gain_right.begin(), n, sides.b);
  } else {
    dsp::equal_power(std::span(pan.values, n), std::span(scratch.gain_left).first(n),
                     std::span(scratch.gain_right).first(n));
  }
  for (std::size_t i = 0; i < n; ++i) {
    scratch.gain_left[i] =
        static_cast<float>(gain.at(i) * static_cast<double>(scratch.gain_left[i]));
    scratch.gain_right[i] =
        static_cast<float>(gain.at(i) * static_cast<double>(scratch.gain_right[i]));
  }
}

// A loudness curve that ends above 0 would end in a click: the voice fades out from the sample the
// curve ended at.
void Voice::end_if_silent(const dsp::Envelope& amp_before, std::int64_t first,
                          std::size_t n) KNOTWAVE_RT {
  const PatchProgram::EnvelopePart& amp =
      patch_->envelopes()[static_cast<std::size_t>(patch_->amp_envelope())];
  const std::int64_t next = first + static_cast<std::int64_t>(n);
  if (modulation_.envelope(patch_->amp_envelope()).is_idle() && !fade_.is_out()) {
    if (amp.program.end_value() == 0) {
      done_ = true;
    } else {
      const std::size_t until =
          amp_before.is_idle() ? 0 : samples_until_idle(amp_before, amp.program, first, n);
      fade_.begin_out(first + static_cast<std::int64_t>(until),
                      samples_of(kStealFadeSeconds, start_.rate_hz));
    }
  }
  if (fade_.is_over(next)) done_ = true;
}

}  // namespace knotwave::engine
