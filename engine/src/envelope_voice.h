// SPDX-License-Identifier: MIT
// One voice of an envelope patch: its envelopes, LFOs and maps, the numbers of its outputs, and the
// places its envelopes pass.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "knotwave/engine/envelope_patch_program.h"

#include "modulation.h"
#include "note_context.h"
#include "tempo_clock.h"

namespace knotwave::engine {

/// An envelope passed the place of an event.
struct Passage {
  base::SampleTime time;
  int event = 0;
};
/// What one call passed; more than fits is dropped.
class Passages {
 public:
  void clear() KNOTWAVE_RT { count_ = 0; }
  /// In order of time.
  void add(const Passage& passage) KNOTWAVE_RT;
  std::span<const Passage> all() const KNOTWAVE_RT { return std::span(passages_).first(count_); }

 private:
  std::array<Passage, 512> passages_;
  std::size_t count_ = 0;
};

class EnvelopeVoice {
 public:
  /// Another gate, its number counted from 1: from rest, or, if `joins` and something still runs,
  /// from where it is. [audio]
  void open(const EnvelopePatchProgram& program, const NoteContext& note, std::uint64_t number,
            base::SampleTime time, double rate_hz, const TempoClock& tempo, bool joins) KNOTWAVE_RT;
  /// Another key under the same gate. [audio]
  void move_to(const NoteContext& note) KNOTWAVE_RT;
  void close(const EnvelopePatchProgram& program, base::SampleTime time,
             int release_velocity) KNOTWAVE_RT;
  /// Reads the player's controllers no more: the channel belongs to another note now. [audio]
  void detach() KNOTWAVE_RT { detached_ = true; }

  /// Outputs' numbers for samples first..first+n-1, n <= kChunk, each to its row at `offset`. One
  /// that has not begun leaves them as they are. Any split gives the same bits. [audio]
  struct Rows {
    double* first = nullptr;  ///< of output 0
    std::size_t length = 0;   ///< of a row
    std::size_t offset = 0;
  };
  void render(const EnvelopePatchProgram& program, const TempoClock& tempo, std::int64_t first,
              std::size_t n, ModulationScratch& scratch, const Rows& rows) KNOTWAVE_RT;
  /// Becomes what renders what `other` would. [audio]
  void look_ahead_from(const EnvelopeVoice& other, const EnvelopePatchProgram& program) KNOTWAVE_RT;
  /// Adds what was passed since the last call up to `until` itself; gates come after. [audio]
  void watch(const EnvelopePatchProgram& program, base::SampleTime until,
             Passages& passages) KNOTWAVE_RT;

  /// As if it had never begun. [audio]
  void forget() KNOTWAVE_RT {
    number_ = 0;
    is_open_ = was_still_ = false;
  }

  bool has_begun() const KNOTWAVE_RT { return number_ > 0; }
  bool gate_is_open() const KNOTWAVE_RT { return is_open_; }
  /// Its gate is open or an envelope still runs. [audio]
  bool is_active(const EnvelopePatchProgram& program) const KNOTWAVE_RT;
  /// Outputs stay as they are from `first` on while nothing happens. [audio]
  bool is_still(const EnvelopePatchProgram& program, std::int64_t first) const KNOTWAVE_RT;
  const NoteContext& note() const KNOTWAVE_RT { return note_; }
  std::uint64_t number() const KNOTWAVE_RT { return number_; }
  const Modulation& modulation() const KNOTWAVE_RT { return modulation_; }

 private:
  std::int64_t turns(const dsp::Envelope& envelope, const dsp::EnvelopeProgram& program,
                     const PlaceEventSpec& event, base::SampleTime time) const KNOTWAVE_RT;
  void watch_one(const EnvelopePatchProgram& program, std::size_t event, base::SampleTime until,
                 Passages& passages) KNOTWAVE_RT;
  void render_output(const EnvelopePatchProgram& program, std::size_t index, std::size_t n,
                     ModulationScratch& scratch, std::span<double> out) KNOTWAVE_RT;

  Modulation modulation_;
  NoteContext note_;
  std::uint64_t number_ = 0;
  bool is_open_ = false, detached_ = false;
  bool was_still_ = false;  ///< when it was rendered last: numbers_ stay
  std::array<double, kMaxOutputs> numbers_{};
  std::array<curves::CurveCursor, kMaxOutputs> cursors_;
  base::SampleTime watched_;
  /// How often each event's place was passed since the gate moved, less 1.
  std::array<std::int64_t, kMaxPlaceEvents> turns_{};
};

}  // namespace knotwave::engine
