// SPDX-License-Identifier: MIT
// What an envelope player is made of. Messages and rendering are in envelope_player.cpp, notes in
// envelope_player_notes.cpp, the song position in envelope_player_clock.cpp.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "knotwave/engine/envelope_player.h"
#include "knotwave/engine/mpe.h"
#include "knotwave/engine/note_stack.h"

#include "clock_gate.h"
#include "envelope_voice.h"
#include "member_channels.h"
#include "output_trims.h"
#include "slot_targets.h"
#include "voice_slots.h"

namespace knotwave::engine {

inline constexpr int kGateKey = 60;  ///< of gates that no key opens
inline constexpr int kGateVelocity = 100;

struct EnvelopePlayer::State {
  State(const EnvelopePlayerConfig& player_config, const EnvelopePatchProgram& player_program);

  // envelope_player.cpp
  base::SampleTime heard_at(base::SampleTime time) const KNOTWAVE_RT;
  void handle_midi(const base::MidiEvent& midi, base::SampleTime time) KNOTWAVE_RT;
  void handle_control(int channel, int controller, int value, base::SampleTime time) KNOTWAVE_RT;
  void configure_mpe(int channel, int members, base::SampleTime time) KNOTWAVE_RT;
  void reset_system(base::SampleTime time) KNOTWAVE_RT;
  void render(std::size_t n) KNOTWAVE_RT;
  void predict(std::size_t n) KNOTWAVE_RT;
  void set_target(const Event& event, base::SampleTime time) KNOTWAVE_RT;
  void release_all() KNOTWAVE_RT;
  void end_all() KNOTWAVE_RT;
  void let_all_go(base::SampleTime time) KNOTWAVE_RT;
  void fill_with_rest() KNOTWAVE_RT;
  void render_voice(EnvelopeVoice& voice, std::int64_t first, std::size_t n,
                    const EnvelopeVoice::Rows& rows) KNOTWAVE_RT;
  EnvelopeVoice::Rows rows(std::size_t voice, std::size_t offset) KNOTWAVE_RT;
  void forget_taken() KNOTWAVE_RT;
  void emit(const PlayerMessage& message) KNOTWAVE_RT;
  void emit_midi(int status, int channel, int key, int velocity, base::SampleTime time) KNOTWAVE_RT;
  void tell_places(base::SampleTime until) KNOTWAVE_RT;
  void tell_place(const Passage& passage) KNOTWAVE_RT;
  void end_place_note(std::size_t event) KNOTWAVE_RT;

  // envelope_player_notes.cpp
  bool hears(int channel) const KNOTWAVE_RT;
  bool is_selected(int channel) const KNOTWAVE_RT;
  void note_on(int channel, int key, int velocity, base::SampleTime time) KNOTWAVE_RT;
  void note_off(int channel, int key, int velocity, base::SampleTime time) KNOTWAVE_RT;
  void pass_on(int channel, int key, int velocity, base::SampleTime time) KNOTWAVE_RT;
  void pass_off(int channel, int key, int velocity, base::SampleTime time) KNOTWAVE_RT;
  void end_passed(int channel, base::SampleTime time) KNOTWAVE_RT;
  void end_passed(int channel, int key, base::SampleTime time) KNOTWAVE_RT;
  void play_poly(int channel, int key, int velocity, base::SampleTime time) KNOTWAVE_RT;
  void play_mono(int channel, int key, int velocity, base::SampleTime time) KNOTWAVE_RT;
  struct Chosen {
    int channel = -1;  ///< none
    const NoteStack::Entry* entry = nullptr;
  };
  Chosen choose() const KNOTWAVE_RT;
  void settle_mono(base::SampleTime time, int release_velocity) KNOTWAVE_RT;
  int place_for_note() const KNOTWAVE_RT;
  NoteContext context(int channel, int key, int velocity, std::uint64_t number) const KNOTWAVE_RT;
  void open(std::size_t voice, const NoteContext& note, base::SampleTime time,
            bool joins) KNOTWAVE_RT;
  void close(std::size_t voice, base::SampleTime time, int release_velocity) KNOTWAVE_RT;
  /// These move keys and pedals of one channel; settle_mono() comes once behind all of them.
  bool sustains(int channel) const KNOTWAVE_RT;
  bool holds_sostenuto(int channel) const KNOTWAVE_RT;
  void update_pedals(int channel, base::SampleTime time) KNOTWAVE_RT;
  void lift_keys(int channel, base::SampleTime time) KNOTWAVE_RT;
  void silence(int channel, base::SampleTime time) KNOTWAVE_RT;
  void choke(const Event& event, base::SampleTime time) KNOTWAVE_RT;
  void follow_gate(int channel, base::SampleTime time) KNOTWAVE_RT;
  void follow_loop(base::SampleTime time) KNOTWAVE_RT;
  void take_trigger(bool by_hand, base::SampleTime time) KNOTWAVE_RT;
  void move_gate(double velocity, base::SampleTime time) KNOTWAVE_RT;
  bool speaks_for(int channel, int other) const KNOTWAVE_RT {
    return channel == other || zones.master_of(other) == channel;
  }

  // envelope_player_clock.cpp
  bool is_clocked() const KNOTWAVE_RT;
  void take_edge(const ClockGate::Edge& edge, EnvelopeVoice& voice) const KNOTWAVE_RT;
  void take_edges_until(base::SampleTime time) KNOTWAVE_RT;
  void advance_clocked(ClockGate& gate, EnvelopeVoice& voice, std::int64_t first, std::size_t n,
                       std::size_t offset, bool is_real) KNOTWAVE_RT;
  void start_song(base::SampleTime time) KNOTWAVE_RT;
  void continue_song(base::SampleTime time) KNOTWAVE_RT;
  void stop_song(base::SampleTime time) KNOTWAVE_RT;
  void run_song(double beats, base::SampleTime time) KNOTWAVE_RT;
  void mend_song(double beats, base::SampleTime time) KNOTWAVE_RT;
  void place_song(double beats, base::SampleTime time) KNOTWAVE_RT;
  void hear_clock(base::SampleTime time) KNOTWAVE_RT;

  const EnvelopePlayerConfig config;
  const EnvelopePatchProgram& program;
  const EnvelopePatchSpec& spec;
  const TriggerSpec& trigger;
  std::int64_t now = 0;
  std::size_t rendered = 0, ahead = 0;  ///< of the values
  std::size_t row_length = 0;
  std::vector<double> values;  ///< [voice][output][row_length]
  ModulationScratch scratch;

  // What was heard.
  TempoClock tempo;
  std::array<ChannelState, 16> channels;
  MpeZones zones;
  SlotTargets targets;
  OutputTrims trims;
  bool is_by_hand = false;  ///< kSlotGate opens the gate, not the trigger
  bool hand_is_open = false;

  // Who plays. `slots` says what keeps each gate open.
  std::vector<EnvelopeVoice> voices;
  std::vector<VoiceSlot> slots;
  std::vector<int> out_channels;  ///< of each voice's note, 1..16
  EnvelopeVoice ahead_voice;
  std::uint64_t notes = 0;
  bool is_poly = false;
  std::array<NoteStack, 16> stacks;
  std::array<std::array<std::uint64_t, 128>, 16> pressed{};  ///< when, in order
  std::uint64_t presses = 0;
  std::array<bool, 16> sustain_was_on{}, sostenuto_was_on{};
  std::uint32_t open_channels = 0;  ///< trigger from a controller: where it is open
  MemberChannels members;
  std::array<std::array<std::uint8_t, 128>, 16> passed{};  ///< NoteOutput::thru: not let go yet

  // The song.
  ClockGate clock;
  bool is_halted = false;  ///< by release_all()
  bool is_stopped = false;
  double stopped_at = 0;         ///< the song position
  bool awaits_clock = false;     ///< Start came, the first clock is the beginning
  bool waits_for_clock = false;  ///< and nothing plays before it
  std::int64_t last_clock = -1;  ///< when one came, or -1

  // What goes out.
  std::array<PlayerMessage, kMostMessages> messages;
  std::size_t message_count = 0;
  bool is_taken = false;
  Passages passages;
  struct Sounding {
    bool is_on = false;
    base::SampleTime end;
  };
  std::array<Sounding, kMaxPlaceEvents> sounding{};
};

}  // namespace knotwave::engine
