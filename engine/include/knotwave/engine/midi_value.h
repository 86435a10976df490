// SPDX-License-Identifier: MIT
// A number that MIDI messages tell step by step: a controller, a parameter, bend or pressure. What
// a receiver of them holds.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "knotwave/base/midi_event.h"
#include "knotwave/base/result.h"
#include "knotwave/engine/envelope_patch.h"

namespace knotwave::engine {

/// Which number, on whatever channel.
struct MidiValueSpec {
  OutputKind kind = OutputKind::control;  ///< control to poly_pressure
  int number = 0;                         ///< CC 0..119 (bits 14: 0..31), NRPN 0..16383
  int bits = 7;                           ///< 7 or 14; bend has 14, pressures 7
  friend bool operator==(const MidiValueSpec&, const MidiValueSpec&) = default;
};

/// "cc74", "nrpn100", "bend", "pressure", "poly_pressure" as in envelope patches; `bits` 0 is what
/// the kind has, or 7. Errors: unknown_name (with the nearest word), value_out_of_range (no such
/// controller or parameter, or it has no so many bits). [control]
Result<MidiValueSpec> parse_midi_value(std::string_view word, int bits = 0);
/// The word of `kind` and its number alone, nothing where it is none. [control]
std::optional<MidiValueSpec> find_midi_value(std::string_view word);
/// "cc74", "nrpn100 (14 bit)". [control]
std::string midi_value_text(const MidiValueSpec& spec);

/// The number of one channel. Of 14 bits an upper half puts the lower one to 0 (MIDI 1.0) until
/// that follows; a parameter is told by CC 6 and 38 while CC 99 and 98 select it. poly_pressure is
/// that of the key told last. All [audio].
class MidiValue {
 public:
  explicit MidiValue(const MidiValueSpec& spec) KNOTWAVE_RT : spec_(spec) {}

  /// True when the message told the number, anew or again. The channel is not looked at.
  bool hear(const std::uint8_t (&bytes)[3]) KNOTWAVE_RT;

  /// 0..last_step().
  int step() const KNOTWAVE_RT { return step_; }
  int last_step() const KNOTWAVE_RT { return spec_.bits == 14 ? 16383 : 127; }
  /// The message was the lower half to the upper one heard before it: that was no value by itself.
  bool completes() const KNOTWAVE_RT { return completes_; }

 private:
  bool hear_control(int control, int value) KNOTWAVE_RT;
  void take_half(bool is_high, int value) KNOTWAVE_RT;

  MidiValueSpec spec_;
  int parameter_ = -1;  ///< NRPN that is selected
  int high_ = 0, low_ = 0, step_ = 0;
  bool was_high_ = false, completes_ = false;
};

}  // namespace knotwave::engine
