// SPDX-License-Identifier: MIT
// The computer's keyboard as a musical one: bytes of a terminal become notes and commands. Knows no
// terminal and no clock.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace knotwave::synth {

struct KeyAction {
  enum class Kind { note_on, note_off, octave, panic, record, next_patch, learn, help, quit };
  Kind kind = Kind::quit;
  int key = 0;  ///< of notes: 0..127; of octave: the one the row of letters begins with

  friend bool operator==(const KeyAction&, const KeyAction&) = default;
};

/// A terminal sends no key-ups: a note lasts as long as its key repeats, else kHold.
class Keyboard {
 public:
  static constexpr std::int64_t kHoldNs = 300'000'000;
  static constexpr int kVelocity = 96;

  /// What was typed at a time. Keys a terminal sends as sequences (arrows) mean nothing.
  std::vector<KeyAction> type(std::string_view bytes, std::int64_t now_ns);
  /// Notes that end by now.
  std::vector<KeyAction> expire(std::int64_t now_ns);
  /// When the next note ends; -1: none sounds.
  std::int64_t next_end_ns() const;
  int octave() const { return octave_; }

 private:
  void type_key(char key, std::int64_t now_ns, std::vector<KeyAction>& actions);
  bool skip_sequence(char byte);

  enum class Sequence { none, escape, parameters, one_more };
  Sequence sequence_ = Sequence::none;
  int octave_ = 4;                        ///< middle C is C4
  std::array<std::int64_t, 128> ends_{};  ///< of the sounding notes; 0: silent
};

/// The keys and what they do, one a line.
std::vector<std::string> keyboard_help();

}  // namespace knotwave::synth
