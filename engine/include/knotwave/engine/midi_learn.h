// SPDX-License-Identifier: MIT
// Knobs of any keyboard take the place of the controllers a patch listens to: learnt by moving
// them, picked up softly, kept in a file (docs/live.md).
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/base/midi_event.h"
#include "knotwave/base/result.h"

namespace knotwave::engine {

/// One knob as the file says it. Channels are 1..16; 0: from any, to the one it came on.
struct LearnedKnob {
  int from_channel = 0;
  int from = 0;
  int to_channel = 0;
  int to = 0;  ///< CC source of the patch's maps
  bool is_soft = true;

  friend bool operator==(const LearnedKnob&, const LearnedKnob&) = default;
};

/// A file of kind "midi-learn".
struct LearnSpec {
  std::string about;
  std::vector<LearnedKnob> knobs;

  friend bool operator==(const LearnSpec&, const LearnSpec&) = default;
};

inline constexpr int kMaxLearnedKnobs = 128;

/// 1..119 but those that mean something else together: bank select, data entry and the selection of
/// parameters (0, 6, 32, 38, 96..101).
bool is_learnable(int controller) KNOTWAVE_RT;

/// Errors: those of documents and of read_file_kind(), with line and column; value_out_of_range (a
/// controller that cannot be learnt, too many knobs), duplicate_name (two knobs from one controller
/// or to one). [control]
Result<LearnSpec> parse_midi_learn(std::string_view text, std::string_view source_name);
Result<LearnSpec> read_midi_learn(const std::string& path);
/// Text that parse_midi_learn() reads to an equal spec; the same spec gives the same text.
std::string write_midi_learn(const LearnSpec& spec);

/// All by one thread, or under one lock. Knows no port: two keyboards that send the same controller
/// are one knob.
class MidiLearn {
 public:
  /// How a knob stands to the value in force. Of those that have not met it the player is told
  /// which way to turn.
  enum class PickUp : std::uint8_t {
    unknown,   ///< not moved yet
    held,      ///< what it says goes
    too_low,   ///< left out: turn it up
    too_high,  ///< left out: turn it down
  };
  struct Knob {
    LearnedKnob learned;
    PickUp pick_up = PickUp::unknown;
    int position = -1;  ///< 0..16383; -1: not moved yet
    int in_force = -1;  ///< the same; -1: not known, so the knob is held as soon as it moves
  };
  /// What a message became.
  struct Out {
    int count = 0;
    std::array<base::MidiEvent, 2> messages{};
  };

  /// Errors as parse_midi_learn(), without a place. [control]
  static Result<MidiLearn> create(const LearnSpec& spec);

  /// Controllers that were learnt come out as what they stand for, or not at all while the knob has
  /// not met the value in force: crossed it, or come within a step of 7 bits. A pair of 14 bits
  /// (controllers below 32 and their fine halves) stays one; its fine half ends where it goes to
  /// from 32 on. A fine half that was learnt itself is a knob of its own. All other messages come
  /// out as they are. [audio]
  Out translate(const base::MidiEvent& event) KNOTWAVE_RT;

  /// The next controller that moves (sends two values that differ) stands for `to` from then on;
  /// what it or another knob stood for before is forgotten. Controllers are silent until then, but
  /// for pedals (64 to 69), which are not caught.
  /// False: `to` is none that a knob can stand for, `to_channel` none of 0..16, or there are 128
  /// knobs. [audio]
  bool learn(int to, int to_channel = 0) KNOTWAVE_RT;
  void cancel() KNOTWAVE_RT { learns_ = false; }
  bool is_learning() const KNOTWAVE_RT { return learns_; }
  /// True if some knob stood for it. [audio]
  bool forget(int to, int to_channel = 0) KNOTWAVE_RT;
  /// Knobs changed since create() or the last spec(): worth saving. [audio]
  bool has_changed() const KNOTWAVE_RT { return has_changed_; }

  /// Another way than by a message through here a controller took a value, 0..16383 (128 for each
  /// step of 7 bits); channel 0..15. Negative: not known any more. [audio]
  void set_in_force(int channel, int controller, int value) KNOTWAVE_RT;
  /// Controllers that were heard went back to their power-on values (a panic, a patch that begins
  /// afresh), so knobs have to meet those. A patch that is exchanged under its controllers needs
  /// nothing: they are where the knobs are. [audio]
  void controllers_went_back() KNOTWAVE_RT;

  int size() const KNOTWAVE_RT { return size_; }
  /// `index` is 0..size() - 1. [audio]
  const Knob& knob(int index) const KNOTWAVE_RT { return knobs_[static_cast<std::size_t>(index)]; }
  /// For write_midi_learn(); has_changed() is false afterwards. [control]
  LearnSpec spec();

 private:
  MidiLearn() { in_force_.fill(kNothing); }
  Knob* knob_from(int channel, int controller) KNOTWAVE_RT;
  Out move(Knob& knob, const base::MidiEvent& event, bool is_fine) KNOTWAVE_RT;
  void heed(const base::MidiEvent& event) KNOTWAVE_RT;
  void catch_moved(const base::MidiEvent& event) KNOTWAVE_RT;
  void erase(int index) KNOTWAVE_RT;
  void refresh(int channel, int controller) KNOTWAVE_RT;
  void reset_controllers(int channel) KNOTWAVE_RT;

  static constexpr std::array<std::int16_t, 120> kNothing = [] {
    std::array<std::int16_t, 120> nothing{};
    nothing.fill(-1);
    return nothing;
  }();

  std::string about_;
  std::array<Knob, kMaxLearnedKnobs> knobs_{};
  int size_ = 0;
  std::array<std::array<std::int16_t, 120>, 16> in_force_{};  ///< 14 bits; -1: not known
  bool has_changed_ = false;
  bool learns_ = false;
  LearnedKnob wanted_;
  std::array<std::array<std::int16_t, 120>, 16> heard_{};  ///< since learn()
};

}  // namespace knotwave::engine
