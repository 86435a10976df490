// SPDX-License-Identifier: MIT
// What one MIDI channel has been told: controllers with their fine halves, registered parameters,
// bend, pressure, pedals and programs. Knows no note and no voice. docs/engine.md lists every
// message.
#pragma once
#include <array>
#include <cstdint>

#include "knotwave/base/rt.h"

namespace knotwave::engine {

/// Controller numbers the engine itself gives a meaning to.
inline constexpr int kBankMsb = 0;
inline constexpr int kPortamentoTime = 5;
inline constexpr int kDataEntryMsb = 6;
inline constexpr int kVolume = 7;
inline constexpr int kPan = 10;
inline constexpr int kExpression = 11;
inline constexpr int kBankLsb = 32;
inline constexpr int kDataEntryLsb = 38;
inline constexpr int kSustain = 64;
inline constexpr int kPortamento = 65;
inline constexpr int kSostenuto = 66;
inline constexpr int kSoft = 67;
inline constexpr int kTimbre = 74;
inline constexpr int kPortamentoControl = 84;
inline constexpr int kDataIncrement = 96;
inline constexpr int kDataDecrement = 97;
inline constexpr int kNrpnLsb = 98;
inline constexpr int kNrpnMsb = 99;
inline constexpr int kRpnLsb = 100;
inline constexpr int kRpnMsb = 101;
inline constexpr int kAllSoundOff = 120;
inline constexpr int kResetControllers = 121;
inline constexpr int kAllNotesOff = 123;
inline constexpr int kOmniOff = 124;
inline constexpr int kOmniOn = 125;
inline constexpr int kMonoOn = 126;
inline constexpr int kPolyOn = 127;

/// One channel's memory. All [audio]; data bytes above 127 are cut to 7 bits.
class ChannelState {
 public:
  /// What a control change asks of the notes of the channel.
  enum class Effect : std::uint8_t {
    none,
    pedals,         ///< sustain or sostenuto moved
    all_sound_off,  ///< silence at once
    all_notes_off,  ///< keys up; pedals still hold
    note_mode,      ///< CC 126 or 127: keys up, then note_mode() for mono_channels()
    mpe_zone,       ///< RPN 6: members() channels
    bend_range,     ///< RPN 0 moved
  };

  /// What a message said in place of the patch.
  enum class Portamento : std::uint8_t { as_patch, off, on };
  enum class NoteMode : std::uint8_t { as_patch, mono, poly };

  ChannelState() KNOTWAVE_RT { reset(); }
  /// Power-on values: volume 100, expression 127, pan and timbre centre, program and bank 0.
  void reset() KNOTWAVE_RT;
  /// CC 121 as MMA RP-015 has it: modulation, expression, pedals (portamento is one, and goes back
  /// to what the patch says), bend, pressures and the parameter selection go back, and a source
  /// note of CC 84 is forgotten; volume, pan, sound controllers, portamento time, bank, program,
  /// tuning and note mode stay.
  void reset_controllers() KNOTWAVE_RT;

  /// `own_bend_range` is what bend_range_semitones() falls back to: the cents and steps of RPN 0
  /// start from the range in force.
  Effect control_change(int controller, int value, double own_bend_range = 2) KNOTWAVE_RT;
  void program_change(int program) KNOTWAVE_RT;
  void pitch_bend(int lsb, int msb) KNOTWAVE_RT { bend_ = ((msb & 127) << 7) | (lsb & 127); }
  void channel_pressure(int value) KNOTWAVE_RT { channel_pressure_ = value & 127; }
  void poly_pressure(int key, int value) KNOTWAVE_RT;
  /// A new note starts without the pressure its key had before.
  void forget_poly_pressure(int key) KNOTWAVE_RT { poly_pressure(key, 0); }
  /// Used when a zone is set up: as if RPN 0 had never been heard. [audio]
  void forget_bend_range() KNOTWAVE_RT { bend_range_cents_ = -1; }
  /// Used where one member of a zone speaks for the others. [audio]
  void take_bend_range(const ChannelState& other) KNOTWAVE_RT {
    bend_range_cents_ = other.bend_range_cents_;
  }

  /// 0..1. Controllers 0..31 have 14 bits once their fine half (32..63) was heard, else 7.
  double control(int controller) const KNOTWAVE_RT;
  /// 0..127, as it was sent: of controllers 0..31 the coarse half.
  int seven_bits(int controller) const KNOTWAVE_RT {
    const auto index = static_cast<std::size_t>(controller & 127);
    return index >= 32 && index < 64 ? fine_[index - 32] : coarse_[index];
  }
  /// -1..1; 8192 is exactly 0, 0 exactly -1 and 16383 exactly 1.
  double bend() const KNOTWAVE_RT;
  /// RPN 0 in semitones, or `fallback` while none was heard.
  double bend_range_semitones(double fallback) const KNOTWAVE_RT {
    return bend_range_cents_ < 0 ? fallback : bend_range_cents_ / 100.0;
  }
  /// RPN 1 and 2 together.
  double tuning_semitones() const KNOTWAVE_RT;
  double pressure() const KNOTWAVE_RT { return channel_pressure_ / 127.0; }
  double poly_pressure(int key) const KNOTWAVE_RT {
    return poly_pressure_[static_cast<std::size_t>(key & 127)] / 127.0;
  }
  /// (CC 7 * CC 11)^2, the 40 log10 law of General MIDI; 1 with both full.
  double volume_gain() const KNOTWAVE_RT;
  /// CC 10 as 0..1: 0 and 1 are hard left, 64 exactly 0.5, 127 hard right.
  double pan_position() const KNOTWAVE_RT;

  bool sustain() const KNOTWAVE_RT { return coarse_[kSustain] >= 64; }
  bool sostenuto() const KNOTWAVE_RT { return coarse_[kSostenuto] >= 64; }
  bool soft() const KNOTWAVE_RT { return coarse_[kSoft] >= 64; }
  /// CC 65: from 64 on; as_patch while none was heard.
  Portamento portamento() const KNOTWAVE_RT { return portamento_; }
  /// CC 5, 14 bits with CC 37: 5 s times the cube of its 0..1, or `fallback` while none was heard.
  double portamento_seconds(double fallback) const KNOTWAVE_RT;
  /// CC 84: the key the next note glides from, or -1; only the first call after it has it.
  int take_portamento_source() KNOTWAVE_RT;
  NoteMode note_mode() const KNOTWAVE_RT { return note_mode_; }
  /// How many channels, from this one up, the last CC 126 or 127 was about; 0 = all that are left.
  int mono_channels() const KNOTWAVE_RT { return mono_channels_; }
  /// Used when a CC 126 or 127 on a channel below speaks for this one too. [audio]
  void set_note_mode(NoteMode mode) KNOTWAVE_RT { note_mode_ = mode; }
  bool timbre_was_sent() const KNOTWAVE_RT { return timbre_sent_; }
  int program() const KNOTWAVE_RT { return program_; }
  /// The bank selected when the program was chosen.
  int bank_msb() const KNOTWAVE_RT { return bank_msb_; }
  int bank_lsb() const KNOTWAVE_RT { return bank_lsb_; }
  int mpe_members() const KNOTWAVE_RT { return mpe_members_; }
  void release_pedals() KNOTWAVE_RT { coarse_[kSustain] = coarse_[kSostenuto] = 0; }

 private:
  Effect data_entry(bool coarse, int value, double own_bend_range) KNOTWAVE_RT;
  void select_parameter(int controller, int value) KNOTWAVE_RT;
  Effect step_data(int step, double own_bend_range) KNOTWAVE_RT;
  /// The range in force.
  int bend_range_cents(double own_bend_range) const KNOTWAVE_RT;
  void store(int controller, int value) KNOTWAVE_RT;

  static constexpr int kNoParameter = 0x3FFF;  ///< RPN 127/127, the null parameter

  std::array<std::uint8_t, 128> coarse_;
  std::array<std::uint8_t, 32> fine_;
  std::array<bool, 32> has_fine_;
  std::array<std::uint8_t, 128> poly_pressure_;
  int bend_;
  int channel_pressure_;
  int program_, bank_msb_, bank_lsb_;
  int parameter_;         ///< the selected RPN
  bool registered_;       ///< the last selection was an RPN, not an NRPN
  int bend_range_cents_;  ///< < 0: never set
  int fine_tuning_;       ///< 14 bits, 8192 = 0
  int coarse_tuning_;     ///< 7 bits, 64 = 0
  int mpe_members_;
  bool timbre_sent_;
  Portamento portamento_;
  bool has_portamento_time_;
  int portamento_source_;  ///< -1: none
  NoteMode note_mode_;
  int mono_channels_;
};

}  // namespace knotwave::engine
