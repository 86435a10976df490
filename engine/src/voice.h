// SPDX-License-Identifier: MIT
// One sounding note: sources, crossfade, shaper, filter, loudness, pan. docs/engine.md draws it.
#pragma once
#include <array>
#include <optional>
#include <span>

#include "knotwave/base/time.h"
#include "knotwave/dsp/filter.h"
#include "knotwave/dsp/glide.h"
#include "knotwave/dsp/oscillator.h"
#include "knotwave/dsp/shaper.h"
#include "knotwave/dsp/smoother.h"
#include "knotwave/engine/patch_program.h"

#include "fade.h"
#include "modulation.h"
#include "note_context.h"

namespace knotwave::engine {

inline constexpr double kStealFadeSeconds = 0.005;    ///< stolen, choked, silenced
inline constexpr double kInstallFadeSeconds = 0.020;  ///< a held note goes over to a new bank
inline constexpr double kBendGlideSeconds = 0.005;    ///< pitch bend and channel tuning
inline constexpr double kVelocityGlideSeconds = 0.005;

/// What every voice starts with: peak 1 at velocity 127 leaves the voice at -9 dB, less 3 dB of
/// centre pan. See Gain staging in docs/engine.md.
inline constexpr double kVoiceHeadroomDb = -9;
inline constexpr double kSoftPedalDb = -5;

/// What one chunk is worked out in; one a thread.
struct VoiceScratch {
  ModulationScratch modulation;
  ChunkBuffer glide{}, bend{}, pitch{}, source_pitch{}, gain{}, amp{}, work{}, pan{}, fade_a{},
      fade_b{};
  Signal fade_gain_a, fade_gain_b;  ///< of the two crossfaded sources
  std::array<float, kChunk> mix_left{}, mix_right{}, source_left{}, source_right{};
  std::array<float, kChunk> control_a{}, control_b{}, gain_left{}, gain_right{};
  std::array<base::Phase, kChunk> increments{};
};

/// How a voice comes to the pitch of a new note.
struct Portamento {
  double seconds = 0;          ///< 0: it is there at once
  std::optional<double> from;  ///< a note number of 12-TET; none: from where it sounds
};

class Voice {
 public:
  struct Start {
    const PatchProgram* patch = nullptr;
    NoteContext note;
    base::SampleTime time;
    double gain_lin = 1;  ///< of the bank and its entry
    double rate_hz = 48000;
    Portamento portamento;
  };

  /// Begins a note. [audio] Its first sample is first_sample(time), or a later one: envelopes, LFOs
  /// and glide are functions of time and go on from there, oscillators begin there.
  void start(const Start& start, const TempoClock& tempo) KNOTWAVE_RT;
  /// Another note on the same voice; `joins`: envelopes retrigger from where they are. [audio]
  void play(const NoteContext& note, base::SampleTime time, bool joins,
            const Portamento& portamento, const TempoClock& tempo) KNOTWAVE_RT;
  /// Closes the gate. [audio]
  void release(base::SampleTime time, int velocity) KNOTWAVE_RT;
  /// Silent `seconds` after `sample`, whatever the envelopes do. [audio]
  void fade_out(std::int64_t sample, double seconds) KNOTWAVE_RT;
  void fade_in(std::int64_t sample, double seconds) KNOTWAVE_RT;
  /// The note's own numbers and sources, by set_note events. [audio]
  NoteContext& note() KNOTWAVE_RT { return start_.note; }
  /// Reads the player's controllers no more: the channel belongs to another note now. [audio]
  void detach() KNOTWAVE_RT { detached_ = true; }

  /// Samples first..first+n-1, overwriting; [n] each. Any n; any split gives the same bits. [audio]
  void render(std::int64_t first, const TempoClock& tempo, VoiceScratch& scratch,
              std::span<float> left, std::span<float> right) KNOTWAVE_RT;

  /// Nothing more will be heard. [audio]
  bool is_done() const KNOTWAVE_RT { return done_; }
  /// Whether it may be done when it is rendered up to `sample`: false only where it will not.
  /// [audio]
  bool may_end_by(std::int64_t sample) const KNOTWAVE_RT;
  /// Loudness at the last sample, for the choice of what to steal. [audio]
  double level() const KNOTWAVE_RT { return level_; }
  /// 0..1 along the amp envelope at `sample`. [audio]
  double envelope_place(std::int64_t sample) const KNOTWAVE_RT;
  double pitch_target() const KNOTWAVE_RT { return glide_.target(); }
  const Start& begun() const KNOTWAVE_RT { return start_; }
  int take_limited_joins() KNOTWAVE_RT { return modulation_.take_limited_joins(*start_.patch); }

 private:
  void render_chunk(std::int64_t first, std::size_t n, const TempoClock& tempo,
                    VoiceScratch& scratch, float* left, float* right) KNOTWAVE_RT;
  void render_pitch(std::int64_t first, std::size_t n, VoiceScratch& scratch, Signal& key_pitch,
                    Signal& pitch) KNOTWAVE_RT;
  void render_crossfade(std::size_t n, VoiceScratch& scratch) KNOTWAVE_RT;
  void render_sources(std::int64_t first, std::size_t n, const Signal& pitch,
                      VoiceScratch& scratch) KNOTWAVE_RT;
  void render_oscillator(std::size_t index, std::size_t n, const Signal& pitch,
                         VoiceScratch& scratch) KNOTWAVE_RT;
  void mix_source(int source, const PatchProgram::Source& part, std::size_t n,
                  VoiceScratch& scratch) KNOTWAVE_RT;
  void shape(std::size_t n, VoiceScratch& scratch) KNOTWAVE_RT;
  void filter(std::size_t n, const Signal& key_pitch, VoiceScratch& scratch) KNOTWAVE_RT;
  void render_amp(std::int64_t first, std::size_t n, VoiceScratch& scratch) KNOTWAVE_RT;
  void end_if_silent(const dsp::Envelope& amp_before, std::int64_t first,
                     std::size_t n) KNOTWAVE_RT;
  void widen_if_panned() KNOTWAVE_RT;
  double velocity_gain() const KNOTWAVE_RT;
  /// As a note number of 12-TET.
  double key_pitch_of_note() const KNOTWAVE_RT;

  Start start_;
  const PatchProgram* patch_ = nullptr;
  double static_gain_ = 1;
  double level_ = 0;
  bool done_ = true;
  bool detached_ = false;
  bool is_mono_ = true;  ///< left and right do not differ before the pan of the voice
  dsp::Glide glide_;
  Fade fade_;
  dsp::Smoother bend_, velocity_gain_;
  Modulation modulation_;
  std::array<dsp::TableOscillator, kMaxOscillators> oscillators_;
  dsp::Shaper shaper_left_, shaper_right_;
  dsp::StateVariableFilter filter_left_, filter_right_;
};

}  // namespace knotwave::engine
