// SPDX-License-Identifier: MIT
// One voice's envelopes, LFOs and maps, evaluated at every sample in the patch's own order.
#pragma once
#include <array>
#include <span>

#include "knotwave/dsp/envelope.h"
#include "knotwave/dsp/lfo.h"
#include "knotwave/dsp/smoother.h"
#include "knotwave/engine/patch_program.h"

#include "chunk_signal.h"
#include "note_context.h"
#include "tempo_clock.h"

namespace knotwave::engine {

/// What one chunk of one voice works on; a thread has one and every voice it renders uses it. Begun
/// with zeros, so that its pages are there before the audio thread comes to them.
struct ModulationScratch {
  std::array<Signal, kSlotCount> slots{};  ///< what the maps add up to
  std::array<ChunkBuffer, kSlotCount> slot_values{};
  std::array<ChunkBuffer, kMaxVoiceEnvelopes> envelopes{};
  std::array<ChunkBuffer, kMaxLfos> lfos{};
  std::array<ChunkBuffer, curves::kMaxControls> controls{};
  ChunkBuffer source{}, source_v{}, shaped{}, beats{};
};

/// The numbers of a curve that maps move, at every sample of a chunk: pointers to [n] each.
struct MovedNumbers {
  std::array<const double*, curves::kMaxControls> values;
  std::size_t count = 0;
  bool all_constant = true;

  std::span<const double* const> all() const KNOTWAVE_RT { return std::span(values).first(count); }
};
/// Those in `slots`, good until the next call with this scratch. [audio]
MovedNumbers moved_numbers(std::span<const int> slots, std::size_t n,
                           ModulationScratch& scratch) KNOTWAVE_RT;

class Modulation {
 public:
  /// Everything from rest. [audio]
  void start(const PatchProgram& patch, const NoteContext& note, base::SampleTime time,
             double rate_hz, const TempoClock& tempo) KNOTWAVE_RT;
  /// A new note on a sounding voice: envelopes join from where they are. [audio]
  void retrigger(const PatchProgram& patch, const NoteContext& note, base::SampleTime time,
                 double rate_hz, const TempoClock& tempo) KNOTWAVE_RT;
  void release(const PatchProgram& patch, base::SampleTime time) KNOTWAVE_RT;
  /// Lets sources glide to what the player does now, from `sample` on. [audio]
  void follow(const PatchProgram& patch, const NoteContext& note, std::int64_t sample) KNOTWAVE_RT;
  /// Fills scratch.slots, scratch.envelopes and scratch.lfos for samples first..first+n-1. [audio]
  void render(const PatchProgram& patch, const NoteContext& note, const TempoClock& tempo,
              std::int64_t first, std::size_t n, ModulationScratch& scratch) KNOTWAVE_RT;

  /// What `other` would render next, without it: only what the patch has is copied. [audio]
  void look_ahead_from(const Modulation& other, const PatchProgram& patch) KNOTWAVE_RT;
  /// No envelope runs and no source glides any more from `first` on, so that all but LFOs stays as
  /// it is. [audio]
  bool is_still(const PatchProgram& patch, std::int64_t first) const KNOTWAVE_RT;

  const dsp::Envelope& envelope(int index) const KNOTWAVE_RT {
    return envelopes_[static_cast<std::size_t>(index)];
  }
  /// Joins that were C0 since the last call. [audio]
  int take_limited_joins(const PatchProgram& patch) KNOTWAVE_RT;

 private:
  struct Player {
    dsp::Smoother source, source_v;
    curves::CurveCursor cursor;
  };
  void open_gates(const PatchProgram& patch, const NoteContext& note, base::SampleTime time,
                  double rate_hz, const TempoClock& tempo) KNOTWAVE_RT;
  using SlotNumbers = std::array<double, kSlotCount>;
  static double value_at_note_on(const PatchProgram::MapPart& map, const Player& player,
                                 const SlotNumbers& slots) KNOTWAVE_RT;
  SlotNumbers numbers_at_note_on(const PatchProgram& patch,
                                 const NoteContext& note) const KNOTWAVE_RT;
  void render_map(const PatchProgram& patch, const NoteContext& note, std::size_t index,
                  std::int64_t first, std::size_t n, ModulationScratch& scratch) KNOTWAVE_RT;
  void render_envelope(const PatchProgram& patch, std::size_t index, std::int64_t first,
                       std::size_t n, ModulationScratch& scratch) KNOTWAVE_RT;
  void follow_song(const PatchProgram& patch, const TempoClock& tempo) KNOTWAVE_RT;
  void render_lfo(const PatchProgram& patch, const NoteContext& note, std::size_t index,
                  const TempoClock& tempo, std::int64_t first, std::size_t n,
                  ModulationScratch& scratch) KNOTWAVE_RT;

  std::array<dsp::Envelope, kMaxVoiceEnvelopes> envelopes_;
  std::array<dsp::Lfo, kMaxLfos> lfos_;
  std::array<Player, kMaxMaps> players_;
  int limited_joins_seen_ = 0;
  std::uint32_t song_moves_seen_ = 0;
};

}  // namespace knotwave::engine
