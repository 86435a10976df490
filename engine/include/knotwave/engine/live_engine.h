// SPDX-License-Identifier: MIT
// The engine under a running sound device: messages of many threads come in through rings, banks
// are exchanged while notes sound, and everything that happens is journalled with its sample.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "knotwave/base/result.h"
#include "knotwave/engine/engine.h"
#include "knotwave/engine/journal.h"
#include "knotwave/engine/live_message.h"

namespace knotwave::engine {

inline constexpr int kLiveInputs = 20;  ///< 16 MIDI ports, keyboard, network, control, spare

struct LiveConfig {
  EngineConfig engine;
  int input_messages = 4096;    ///< room of each input's ring
  int journal_records = 65536;  ///< room between two calls of take_journal()
  double tap_s = 2;             ///< room of the ring take_tap() reads
};

/// A picture of the moment for those who show it.
struct LiveStatus {
  std::int64_t now = 0;  ///< engine time, samples
  EngineCounters counters;
  float peak_left = 0, peak_right = 0;  ///< since the last status()
  std::int64_t messages = 0;
  std::int64_t messages_dropped = 0;  ///< no room in a ring, or note-ons over a second late
  std::int64_t messages_late = 0;     ///< heard longer ago than the latency: played at once
  std::int64_t journal_dropped = 0;   ///< a take over this cannot be rendered again
  std::int64_t tap_dropped_frames = 0;
  std::uint8_t last_midi[3] = {0, 0, 0};
  double latency_frames = 0;      ///< from when a message was heard to its first sample
  double envelope_position = -1;  ///< 0..1 in the newest voice's amp envelope; -1: none sounds
  int envelope_patch = -1;        ///< whose: index into BankProgram::patches() of the bank playing
};

class LiveEngine {
 public:
  /// [control] `source` is what the journal will hold of the bank; empty where nobody takes it.
  /// Errors: those of Engine::create(), value_out_of_range.
  static Result<std::unique_ptr<LiveEngine>> create(const LiveConfig& config,
                                                    std::unique_ptr<const BankProgram> bank,
                                                    JournalBank source = {});
  ~LiveEngine();  ///< [control, stopped]

  /// [any] One thread for each input, 0..kLiveInputs-1. Never blocks. False: dropped, and counted.
  /// What ends notes (note-offs, CC 120 and 123 to 127, pedals going up, reset) has as many places
  /// again to itself; where even those are taken, pedals go up and all sound off on its channel,
  /// at its place among the others. Clock and active sensing are passed over.
  bool push(int input, const LiveMessage& message) KNOTWAVE_RT;
  /// Every note ends in 5 ms, every controller and target goes back, at the next block. [any]
  void panic() KNOTWAVE_RT;
  /// The gain moves to `gain_lin` over `seconds`, after tap and journal. [any]
  void fade(float gain_lin, float seconds) KNOTWAVE_RT;

  /// Installed at the start of the next block; sounding notes go over with a crossfade. Of several
  /// for one block only the last is. False: 32 banks are still under way, this one waits (and a
  /// newer one replaces it). [control]
  bool install(std::unique_ptr<const BankProgram> bank, JournalBank source = {});
  /// Frees banks that came back, sends one that waited. Call it some ten times a second. [control]
  void collect();
  /// [control]
  LiveStatus status();

  /// What happened since the last call, in order, appended to `journal`, which is the same one
  /// every time; its settings are filled in, a bank equal to one it has is not added again, and
  /// `first`, `end` and `sha256` are the caller's. [control]
  void take_journal(Journal& journal);
  /// While on, samples (before the fade) are kept for take_tap(). The first is that of the next
  /// block. [control]
  void set_tap(bool on);
  /// Interleaved stereo frames in order into out[2n], up to as many as fit and up to where samples
  /// are missing (switched off, or dropped); returns how many and the engine time of the first.
  /// [control] One thread, which need not be the other calls'.
  struct Tap {
    std::int64_t first = 0;
    std::size_t frames = 0;
  };
  Tap take_tap(std::span<float> interleaved);

  /// Renders a block of any size that the device asked for at `time_ns`. Messages heard since the
  /// last one are placed so that each sounds the same time after it was heard, in whole samples:
  /// LiveStatus::latency_frames, which is the longest recent block and as much more as blocks come
  /// early, 0.5 ms at least. `exact` events of any kind but install_bank, whose time is an offset
  /// in this block, are played where they say, fraction included, the first of those at one sample.
  /// [audio] left and right are overwritten.
  void process(std::int64_t time_ns, std::span<const Event> exact, std::span<float> left,
               std::span<float> right) KNOTWAVE_RT;
  /// As Engine::is_idle(). [audio]
  bool is_idle() const KNOTWAVE_RT;
  /// As Engine::ended_notes(). [audio]
  std::span<const EndedNote> ended_notes() const KNOTWAVE_RT;
  double rate_hz() const KNOTWAVE_RT;  ///< [any]

 private:
  struct State;
  explicit LiveEngine(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace knotwave::engine
