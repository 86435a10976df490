// SPDX-License-Identifier: MIT
// The engine: events in, samples out, the same bits for any block size and number of threads. It
// knows no device and no file.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "knotwave/base/result.h"
#include "knotwave/engine/bank_program.h"
#include "knotwave/engine/event.h"

namespace knotwave::engine {

struct EngineConfig {
  double rate_hz = 48000;  ///< 8000..768000
  int max_voices = 128;    ///< sounding at once; as many again may be fading out
  std::uint64_t seed = 1;  ///< of the performance; joined with each patch's own
  int threads = 1;         ///< 1..64; more than 1 uses workers (offline)
  double volume_db = 0;    ///< master
};

/// A note nobody played: the bank has no patch for its program, or for its drum key.
struct MissingPatch {
  int channel = 0;  ///< from 0; under MPE the master
  int bank_msb = 0, bank_lsb = 0, program = 0;
  int key = -1;  ///< drums: the key; -1 = melodic

  bool operator==(const MissingPatch&) const = default;
};

/// A note that is heard no more and will not be again.
struct EndedNote {
  std::int32_t note = Event::kNoNote;  ///< Event::note of its note on
  int channel = 0, key = 0;
};

/// Counters the audio thread keeps; read them between process() calls.
struct EngineCounters {
  static constexpr int kMissingNamed = 4;

  std::int64_t notes = 0;
  std::int64_t voices_stolen = 0;
  std::int64_t notes_dropped = 0;                   ///< no voice and no fading place
  std::int64_t notes_without_patch = 0;             ///< the bank has no such program or drum key
  std::array<MissingPatch, kMissingNamed> missing;  ///< the first of them that differ
  int missing_count = 0;
  std::int64_t events_late = 0;  ///< before the block; played at its first sample
  std::int64_t events_unknown = 0;
  std::int64_t joins_limited = 0;  ///< C1 was not possible within the hull
  int voices_now = 0;
  int voices_peak = 0;
};

class Engine {
 public:
  /// [control] `bank` must outlive the engine or its replacement by an install_bank event.
  /// Errors: value_out_of_range (so many threads as the system does not start included).
  static Result<std::unique_ptr<Engine>> create(const EngineConfig& config,
                                                const BankProgram* bank);
  ~Engine();

  /// Renders the next out_left.size() samples. [audio] `events` are sorted by time; those at or
  /// past the end of the block must not be given. left and right are overwritten.
  void process(std::span<const Event> events, std::span<float> left,
               std::span<float> right) KNOTWAVE_RT;

  /// Buffers for each of the 16 channels, or none: channel c's own sound of the last process() goes
  /// to stems[c] as left and right [2][n]; their sum in channel order is the mix to the bit.
  /// [control]
  struct Stem {
    std::span<float> left, right;
  };
  void process(std::span<const Event> events, std::span<float> left, std::span<float> right,
               std::span<const Stem> stems) KNOTWAVE_RT;

  /// No voice sounds or will sound without a new event. [audio]
  bool is_idle() const KNOTWAVE_RT;
  /// New notes or sounding voices read `bank`: it must be kept. After an install_bank event the old
  /// one is free 55 ms later at most. [audio]
  bool is_playing(const BankProgram* bank) const KNOTWAVE_RT;
  /// The next sample to be rendered. [audio]
  std::int64_t now() const KNOTWAVE_RT;
  const EngineCounters& counters() const KNOTWAVE_RT;
  /// Those that ended in the last process(), for hosts that follow voices. [audio] Every note on is
  /// told once: of a monophonic patch not before its key and pedals let go too, of a bank without a
  /// patch for it at once. Without order; room for kMostNotesAtOnce note ons in one process().
  static constexpr int kMostNotesAtOnce = 4096;
  std::span<const EndedNote> ended_notes() const KNOTWAVE_RT;
  /// The note begun last of those that sound, for those who show it; patch null: none does. [audio]
  struct Newest {
    const PatchProgram* patch = nullptr;
    double envelope_place = 0;  ///< 0..1 along its amp envelope
  };
  Newest newest() const KNOTWAVE_RT;
  /// Engine time 0, all state as after create(). [control, stopped]
  void reset();

 private:
  struct State;
  explicit Engine(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace knotwave::engine
