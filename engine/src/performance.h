// SPDX-License-Identifier: MIT
// Events to voices: which message opens, moves and closes which voice. docs/engine.md has the table
// of messages. All [audio] but the constructor.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "knotwave/engine/bank_program.h"
#include "knotwave/engine/channel_state.h"
#include "knotwave/engine/engine.h"
#include "knotwave/engine/event.h"
#include "knotwave/engine/mpe.h"
#include "knotwave/engine/note_stack.h"

#include "slot_targets.h"
#include "tempo_clock.h"
#include "voice.h"
#include "voice_slots.h"

namespace knotwave::engine {

inline constexpr int kChannels = 16;

/// Who renders the voices, between one event and the next.
class VoiceUpkeep {
 public:
  /// The voice, and its slot's level, as they are at the event. Called before it is changed.
  virtual void bring(int voice) KNOTWAVE_RT = 0;
  /// The voice begins at the event.
  virtual void add(int voice) KNOTWAVE_RT = 0;

 protected:
  ~VoiceUpkeep() = default;
};

/// What set_note events said of a voice's note.
struct NoteTargets {
  static constexpr int kMostSlots = 16;  ///< of modulation; as many of expression
  SlotTargets modulation{kMostSlots}, expression{kMostSlots};
};

class Performance {
 public:
  explicit Performance(const EngineConfig& config);

  void reset(const BankProgram* bank) KNOTWAVE_RT;
  /// `time` is when the event is heard: its own time, or the present sample if that is later.
  void handle(const Event& event, base::SampleTime time, VoiceUpkeep& upkeep) KNOTWAVE_RT;

  /// Which voices read what an event changes besides voices (a channel's state, the tempo), and
  /// whose channel's volume or pan it moves: those are to be brought before it is handled.
  struct Reach {
    enum class Voices : std::uint8_t { none, key, channel, all };
    Voices voices = Voices::none;
    bool bus = false;
    int channel = 0, key = 0;

    bool holds(const VoiceSlot& slot) const KNOTWAVE_RT {
      if (voices == Voices::none || voices == Voices::all) return voices == Voices::all;
      if (slot.channel != channel && slot.bus != channel) return false;
      return voices == Voices::channel || slot.key == key;
    }
    bool mixes(int of_channel) const KNOTWAVE_RT {
      return bus && (voices == Voices::all || of_channel == channel);
    }
  };
  Reach reach_of(const Event& event) const KNOTWAVE_RT;

  /// When the next notes go over to the bank installed last, or kNever.
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  std::int64_t next_group() const KNOTWAVE_RT { return next_group_; }
  /// They do: all voices that end by `now` have been collected.
  void carry_group_over(std::int64_t now, VoiceUpkeep& upkeep) KNOTWAVE_RT;

  const ChannelState& channel(int c) const KNOTWAVE_RT {
    return channels_[static_cast<std::size_t>(c)];
  }
  const BankProgram* bank() const KNOTWAVE_RT { return bank_; }
  double master_gain() const KNOTWAVE_RT { return master_gain_; }  ///< universal master volume
  const TempoClock& tempo() const KNOTWAVE_RT { return tempo_; }
  VoiceSlots& slots() KNOTWAVE_RT { return slots_; }
  const VoiceSlots& slots() const KNOTWAVE_RT { return slots_; }
  Voice& voice(int index) KNOTWAVE_RT { return voices_[static_cast<std::size_t>(index)]; }
  EngineCounters& counters() KNOTWAVE_RT { return counters_; }
  const EngineCounters& counters() const KNOTWAVE_RT { return counters_; }

  /// As Engine::ended_notes(), since forget_ended_notes().
  std::span<const EndedNote> ended_notes() const KNOTWAVE_RT {
    return std::span(ended_notes_).first(ended_count_);
  }
  void forget_ended_notes() KNOTWAVE_RT { ended_count_ = 0; }

  Engine::Newest newest(std::int64_t sample) const KNOTWAVE_RT;
  /// Frees voices that are done and counts the rest. Called when all are rendered up to a sample.
  void collect() KNOTWAVE_RT;
  void collect(int index) KNOTWAVE_RT;  ///< one voice

 private:
  /// One channel's monophonic instrument.
  struct Mono {
    NoteStack stack;
    int slot = -1;
    const PatchProgram* patch = nullptr;
    PlayMode mode = PlayMode::mono;  ///< mono or legato, as its last key was played
    bool is_drum = false;
  };

  // performance.cpp: messages
  void handle_midi(const base::MidiEvent& midi, base::SampleTime time) KNOTWAVE_RT;
  void handle_system(const base::MidiEvent& midi, base::SampleTime time) KNOTWAVE_RT;
  void handle_control(int channel, int controller, int value, base::SampleTime time) KNOTWAVE_RT;
  void set_note_mode(int channel, base::SampleTime time) KNOTWAVE_RT;
  /// The bend range of a channel that has heard no RPN 0.
  double own_bend_range(int channel) const KNOTWAVE_RT;
  void share_bend_range(int channel) KNOTWAVE_RT;
  void configure_mpe(int channel, int members, base::SampleTime time) KNOTWAVE_RT;
  void reset_system(base::SampleTime time) KNOTWAVE_RT;
  void set_target(const Event& event, base::SampleTime time) KNOTWAVE_RT;
  void update_pedals(int channel, base::SampleTime time) KNOTWAVE_RT;
  void lift_keys(int channel, base::SampleTime time) KNOTWAVE_RT;
  void silence(int channel, base::SampleTime time) KNOTWAVE_RT;
  void release_everything(base::SampleTime time) KNOTWAVE_RT;
  bool speaks_for(int channel, int other) const KNOTWAVE_RT {
    return channel == other || zones_.master_of(other) == channel;
  }
  bool sustains(int channel) const KNOTWAVE_RT;
  bool holds_sostenuto(int channel) const KNOTWAVE_RT;

  // performance_notes.cpp: notes
  void note_on(int channel, int key, int velocity, base::SampleTime time) KNOTWAVE_RT;
  void count_missing(const MissingPatch& missing) KNOTWAVE_RT;
  void note_off(int channel, int key, int velocity, base::SampleTime time) KNOTWAVE_RT;
  void play_poly(int channel, int key, int velocity, const BankProgram::Choice& choice, int source,
                 base::SampleTime time) KNOTWAVE_RT;
  void play_mono(int channel, int key, int velocity, const BankProgram::Choice& choice, int source,
                 base::SampleTime time) KNOTWAVE_RT;
  /// The mono voice goes to the key that now has priority, or is released.
  void settle_mono(int channel, base::SampleTime time, int release_velocity) KNOTWAVE_RT;
  bool mono_sounds(const Mono& mono, int channel) const KNOTWAVE_RT;
  int begin(int channel, const NoteContext& note, const BankProgram::Choice& choice,
            base::SampleTime time, const Portamento& portamento) KNOTWAVE_RT;
  NoteContext context(int channel, int key, int velocity, const BankProgram::Choice& choice,
                      std::uint32_t number) const KNOTWAVE_RT;
  void release(int index, base::SampleTime time, int velocity) KNOTWAVE_RT;
  void fade(int index, base::SampleTime time, double seconds) KNOTWAVE_RT;
  /// The voice as it is at the event, to be changed.
  Voice& brought(int index) KNOTWAVE_RT;
  int victim(int bus, const PatchProgram* patch) KNOTWAVE_RT;

  // performance_numbered.cpp: notes that the player numbers
  void set_note(const Event& event, base::SampleTime time) KNOTWAVE_RT;
  void set_note(int index, const Event& event, std::int64_t sample) KNOTWAVE_RT;
  void choke(const Event& event, base::SampleTime time) KNOTWAVE_RT;
  /// Of a numbered note whose key is down in a monophonic patch; else `channel`.
  int channel_of(std::int32_t number, int channel) const KNOTWAVE_RT;

  // performance_ends.cpp: the end of every note, told once
  void tell_end(int channel, int key, std::int32_t number) KNOTWAVE_RT;
  /// The voice plays its note no more. The end is told unless its key or another voice keeps it.
  void part_from(VoiceSlot& slot) KNOTWAVE_RT;
  bool is_played(std::uint64_t serial) const KNOTWAVE_RT;
  /// Of notes that no key holds any more, unless a voice still plays them.
  void tell_gone() KNOTWAVE_RT;
  /// A mono voice goes on with another note: what was said of the one before glides back.
  void renumber(int index, NoteContext& note, std::int64_t sample) KNOTWAVE_RT;
  /// The note of the voice at `index` reads its own targets.
  void own_targets(int index, NoteContext& note) const KNOTWAVE_RT;

  // performance_install.cpp: a new bank under sounding notes
  void install(const BankProgram* bank, base::SampleTime time) KNOTWAVE_RT;
  bool is_left_behind(const VoiceSlot& slot) const KNOTWAVE_RT;
  void carry_group_over() KNOTWAVE_RT;
  void carry_over(int index, base::SampleTime time) KNOTWAVE_RT;

  // performance_modes.cpp: portamento, mono and poly
  PlayMode play_mode(int channel, const BankProgram::Choice& choice) const KNOTWAVE_RT;
  /// `glides`: whether the patch's own glide is meant here.
  Portamento portamento(int channel, const PatchProgram& patch, bool is_drum,
                        bool glides) const KNOTWAVE_RT;
  /// From the key a CC 84 named, or as above while source < 0.
  Portamento portamento(int channel, const BankProgram::Choice& choice, int key, int source,
                        bool glides) const KNOTWAVE_RT;
  bool tie_to_source(int channel, int key, int velocity, const BankProgram::Choice& choice,
                     int source, base::SampleTime time) KNOTWAVE_RT;

  const EngineConfig config_;
  const BankProgram* bank_ = nullptr;
  std::array<ChannelState, kChannels> channels_;
  std::array<SlotTargets, kChannels> targets_;
  SlotTargets every_channel_;
  MpeZones zones_;
  std::array<Mono, kChannels> monos_;
  std::array<bool, kChannels> sustain_was_on_{}, sostenuto_was_on_{};
  struct LastPitch {
    bool known = false;
    double semitones = 0;
  };
  std::array<LastPitch, kChannels> last_pitch_{};
  std::array<int, kChannels> mono_spans_{};  ///< channels that a CC 126 on each made mono
  TempoClock tempo_;
  double master_gain_ = 1;
  std::int32_t number_ = Event::kNoNote;  ///< of the event being handled
  std::uint64_t serial_ = 0;              ///< of the last note on
  std::uint64_t next_note_ = 0;
  VoiceSlots slots_;
  std::vector<Voice> voices_;
  std::vector<NoteTargets> note_targets_;  ///< [places]
  std::vector<EndedNote> ended_notes_;
  std::size_t ended_count_ = 0;
  std::vector<base::SampleTime> release_times_;  ///< when each voice's gate closed
  EngineCounters counters_;
  int group_ = 0;                      ///< how many notes go over at a time
  std::int64_t next_group_ = kNever;   ///< when
  std::int64_t next_group_start_ = 0;  ///< no earlier than this
  VoiceUpkeep* upkeep_ = nullptr;      ///< while an event is handled
};

}  // namespace knotwave::engine
