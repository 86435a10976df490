// SPDX-License-Identifier: MIT
// Plays one patch of the envelope generator on a virtual clock: events in, the values of its
// outputs at every sample out, of every voice. The same class feeds MIDI (read ahead of time) and
// control voltage (in the audio callback).
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "knotwave/base/result.h"
#include "knotwave/engine/envelope_patch_program.h"
#include "knotwave/engine/event.h"

namespace knotwave::engine {

struct EnvelopePlayerConfig {
  double rate_hz = 48000;  ///< 8000..768000
  std::uint64_t seed = 1;
  int most_ahead_samples = 256;  ///< what predict() may be asked for, 0..65536
};

/// What set_target events may move in an envelope player beside the slots of map_slots.h.
/// + output: an output's number x becomes x + depth (x - rest) + offset |high - low|, with what is
/// set, both 0 at first; either glides for kTargetGlideSeconds. Destinations hold it in their
/// range.
inline constexpr int kSlotOutputDepth = 1024;
inline constexpr int kSlotOutputOffset = kSlotOutputDepth + kMaxOutputs;
/// Other than 0: the patch's own trigger is not heard, kSlotGate alone opens the gate. Notes pass
/// as the patch says. A change closes the gate.
inline constexpr int kSlotGateByHand = kSlotOutputOffset + kMaxOutputs;
/// By hand: 1 to 127 opens the gate with this velocity, as middle C of the trigger's channel (with
/// NoteOutput::mpe that note goes out); 0 closes it.
inline constexpr int kSlotGate = kSlotGateByHand + 1;
/// The song is at this quarter note and runs on from there. From 1/96 on it is another place: a
/// clock division closes its gate, and the next opening comes where it belongs.
inline constexpr int kSlotSong = kSlotGate + 1;
inline constexpr int kSlotSongStops = kSlotSong + 1;  ///< as Stop (FC), whatever the number

/// A note on or off for the patch's NoteOutput, a note or gate of a place event: what must go out
/// as it is.
struct PlayerMessage {
  enum class Kind : std::uint8_t { thru, place_note, place_gate };
  Kind kind = Kind::thru;
  base::MidiEvent midi;  ///< its time is when it happens; place_note: a note on or off
  int place_event = -1;  ///< index in the patch; place_gate: data 2 of midi is 1 or 0
};

class EnvelopePlayer {
 public:
  static constexpr std::size_t kMostSamples = 64;  ///< of one render()
  static constexpr int kMostAhead = 65536;
  /// Between two takes: every key of every channel let go, and 256 of places.
  static constexpr std::size_t kMostMessages = 2304;

  /// [control] `program` must outlive the player. Errors: value_out_of_range.
  static Result<std::unique_ptr<EnvelopePlayer>> create(const EnvelopePlayerConfig& config,
                                                        const EnvelopePatchProgram* program);
  ~EnvelopePlayer();

  /// Everything that happens from now() on: notes, controllers, tempo (Event::Kind::tempo), start,
  /// stop, song position (F2, or Event::Kind::position at once). Times rise; an event before now()
  /// is heard now. [audio]
  ///
  /// Start (FA) puts the song at 0: at the first clock (F8) that follows where clocks came within
  /// the last second, else at once. Stop (FC) closes the gate of a clock division, Continue (FB)
  /// goes on from there or from the last song position (F2). A clock or loop that release_all()
  /// ended begins again with Start or Continue. set_target adds to the slots of map_slots.h and
  /// moves those above, of every channel whatever it says. install_bank is left out.
  void handle(const Event& event) KNOTWAVE_RT;
  /// The next n <= kMostSamples samples; now() grows by n. An event within the block must have been
  /// handled before: split blocks at events. Any split gives the same bits. [audio]
  void render(std::size_t n) KNOTWAVE_RT;
  /// What would come after the last sample rendered if nothing happened: n <= most_ahead_samples
  /// more values behind those of render(), the openings of a clock division among them. State does
  /// not change. [audio] Costs as much as n samples of render() and a copy of what the patch has of
  /// envelopes, LFOs and maps, for every voice that has begun.
  void predict(std::size_t n) KNOTWAVE_RT;

  /// Voices 0..voices()-1 are the patch's polyphony, one with mono and legato and without notes.
  int voices() const KNOTWAVE_RT;
  struct VoiceState {
    bool is_active = false;  ///< its gate is open or an envelope still runs
    bool has_begun = false;  ///< some gate opened since the start
    int channel = 1;         ///< 1..16: of the note, or what NoteOutput::mpe gave it
    int key = 60;
    std::uint64_t note = 0;  ///< counts up with every gate: the largest is the newest
  };
  VoiceState voice(int index) const KNOTWAVE_RT;
  /// The voice whose values an output without a note's channel has: the newest. -1: none has begun.
  int newest_voice() const KNOTWAVE_RT;
  /// Numbers in the output's unit, unrounded, of the last render() and predict() behind it:
  /// [n + ahead]. A voice that has not begun gives `rest`. [audio]
  std::span<const double> values(int voice, int output) const KNOTWAVE_RT;
  /// What happened in handle() and render() since the last take, in order of time. [audio]
  std::span<const PlayerMessage> take_messages() KNOTWAVE_RT;

  std::int64_t now() const KNOTWAVE_RT;  ///< the next sample to be rendered
  /// No gate is open, no clock opens one, nothing that an output hears runs or glides, and no note
  /// or gate of a place is to end: values stay, and nothing is told. LFOs never stand still once a
  /// gate was open. [audio]
  bool is_still() const KNOTWAVE_RT;
  /// Where an envelope of a voice is, for those who show it: 0..1. [audio]
  double place(int voice, int envelope) const KNOTWAVE_RT;
  /// Closes every gate now, lets go the notes that went out, and stays closed to clock and loop.
  /// Keys and controllers open gates again. [audio]
  void release_all() KNOTWAVE_RT;
  /// Closes every gate, lets go the notes that went out and ends every envelope at once: outputs
  /// have their rest value until a gate opens. Clock, loop, controllers and targets go on. [audio]
  void end_all() KNOTWAVE_RT;

 private:
  struct State;
  explicit EnvelopePlayer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace knotwave::engine
