// SPDX-License-Identifier: MIT
// What a knob did: the steps of one MIDI value and their times, from a device or a file.
// [control]
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "knotwave/base/midi_event.h"
#include "knotwave/engine/midi_value.h"

namespace knotwave::engine {

/// From `time` on the value is `step`; it was told last at `last_told`, not before `time`.
struct KnobMove {
  base::SampleTime time, last_told;
  int step = 0;
  friend bool operator==(const KnobMove&, const KnobMove&) = default;
};

inline constexpr std::size_t kMostKnobMoves = std::size_t{1} << 20;

class KnobRecorder {
 public:
  /// Of `channel`, 1..16; 0: the first channel that the value is heard on, of the first port.
  explicit KnobRecorder(const MidiValueSpec& value, int channel = 0);

  /// Events in order of time; one that is earlier than the last counts as simultaneous. A lower
  /// half within 10 ms (48 kHz) of its upper half makes one value with it, at the time of the
  /// lower. O(1).
  void hear(const base::MidiEvent& event);

  /// The value first heard, then each that differs from the one before, with different times.
  const std::vector<KnobMove>& moves() const { return moves_; }
  int last_step() const { return elsewhere_value_.last_step(); }
  int channel() const { return channel_; }               ///< 1..16; 0: nothing was heard yet
  std::int64_t heard() const { return heard_; }          ///< messages with the value
  std::int64_t elsewhere() const { return elsewhere_; }  ///< the same of other channels and ports
  std::int64_t dropped() const { return dropped_; }      ///< moves beyond kMostKnobMoves

 private:
  void take(base::SampleTime time, const MidiValue& value);
  void commit(base::SampleTime time, int step);

  std::array<MidiValue, 16> values_;  ///< of the channels, until one of them is the one
  MidiValue elsewhere_value_;
  int channel_ = 0, port_ = -1;
  std::vector<KnobMove> moves_;
  base::SampleTime time_;
  std::vector<KnobMove>::size_type size_before_ = 0;  ///< the last message: what it may have
  KnobMove last_before_;                              ///< changed of `moves_`
  std::int64_t heard_ = 0, elsewhere_ = 0, dropped_ = 0;
};

}  // namespace knotwave::engine
