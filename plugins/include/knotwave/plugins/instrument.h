// SPDX-License-Identifier: MIT
// The instrument as every plugin format has it: a patch or bank, parameters, events of a block at
// their samples. An adapter turns its host's words into these calls and has no state of its own.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/engine/bank.h"
#include "knotwave/engine/live_engine.h"

namespace knotwave::plugins {

struct InstrumentConfig {
  int max_voices = 128;
};

/// Of the host, at one sample of a block.
struct Transport {
  double beats_per_minute = 0;  ///< quarter notes; 0: not known
  double quarters = 0;          ///< since the song's start
  bool is_playing = false;      ///< the song runs
  bool has_position = false;    ///< `quarters` is known
};

class Instrument {
 public:
  static constexpr std::size_t kMostParameters = 128;
  /// Room for a block's events. Where more come, the block is rendered in parts; of those at one
  /// sample the rest is played a sample later.
  static constexpr std::size_t kEventsAtOnce = 2048;

  /// [control] Plays the first factory preset. Compiles nothing yet.
  explicit Instrument(const InstrumentConfig& config = {});
  ~Instrument();

  // What it plays. All [control]; each all or nothing: after an error everything is as it was.
  // While active the new sound begins with the next block, and sounding notes go over.

  /// A factory preset (factory.h). Parameters stay.
  Result<void> load_preset(std::size_t number);
  /// A patch or bank on the disk. Parameters stay. Errors: those of engine::read_bank() and
  /// BankProgram::create(); unsupported (a patch with a wave_file: plugins read no sounds).
  Result<void> load_file(const std::string& path);
  /// What state() gave, of this version or an older one. Errors: those of engine::read_journal(),
  /// unknown_name (a parameter), malformed, and of the patch inside.
  Result<void> load_state(std::string_view text);
  /// The patch or bank with every file it needs and the parameters that were moved, as a journal of
  /// what happens at time 0 (docs/journal-format.md), which knotwave-render --journal reads too.
  std::string state() const;
  const std::string& name() const { return spec_.name; }  ///< of the patch or bank

  /// [control] Engine time 0, nothing sounds. Rate 8000..768000 Hz. Errors: value_out_of_range.
  Result<void> activate(double rate_hz);
  void deactivate();  ///< [control]
  bool is_active() const { return live_ != nullptr; }
  /// Frees what was replaced. Now and then. [control]
  void collect();

  /// [any] Heard from the next block on; held within its range, NaN is its initial value.
  void set_parameter(std::size_t place, double value) KNOTWAVE_RT;
  double parameter(std::size_t place) const KNOTWAVE_RT;  ///< [any]

  // A block. All [audio], while active: begin(), events in order of time, render().

  void begin(std::span<float> left, std::span<float> right) KNOTWAVE_RT;
  /// `event.time()` counts from the block's first sample. Of any kind but install_bank. System
  /// exclusive is kept by reference until render().
  void add(const engine::Event& event) KNOTWAVE_RT;
  /// From that sample on (over engine::kTargetGlideSeconds).
  void add_parameter(std::size_t place, double value, std::int64_t sample) KNOTWAVE_RT;
  /// Once a block, or where it changes. A tempo that is in force costs nothing. The song's position
  /// is told to the engine where the song begins to play and where it jumps (by more than 1/1000 of
  /// a quarter note), at the next 1/24 of a quarter note, to a 2^-32 of a sample.
  void add_transport(const Transport& transport, std::int64_t sample) KNOTWAVE_RT;
  void render() KNOTWAVE_RT;
  /// Every note ends at once. Parameters and controllers stay.
  void reset() KNOTWAVE_RT;
  bool is_idle() const KNOTWAVE_RT;

 private:
  Result<void> load(engine::BankSpec spec);
  void render_until(std::size_t sample) KNOTWAVE_RT;
  void push(const engine::Event& event) KNOTWAVE_RT;
  void place(const engine::Event& event) KNOTWAVE_RT;
  void place_song() KNOTWAVE_RT;
  void follow_song(const Transport& transport, std::int64_t sample) KNOTWAVE_RT;

  InstrumentConfig config_;
  engine::BankSpec spec_;
  std::unique_ptr<const engine::BankProgram> program_;  ///< compiled and not yet played
  std::unique_ptr<engine::LiveEngine> live_;

  std::array<std::atomic<double>, kMostParameters> wanted_;
  std::atomic<bool> has_news_{true};  ///< some wanted_ may differ from heard_

  // The audio thread.
  std::array<double, kMostParameters> heard_{};
  std::vector<engine::Event> events_;  ///< [kEventsAtOnce]
  std::size_t event_count_ = 0;
  std::span<float> left_, right_;
  std::size_t done_ = 0;  ///< samples of this block that are rendered
  std::uint32_t tempo_microseconds_ = 500000;
  // The host's song: where it would be at the block's first sample if it ran on as it did, and what
  // is still to be told.
  bool is_playing_ = false, is_song_due_ = false;
  double quarters_ = 0;
  base::SampleTime song_due_;
  std::int64_t song_clocks_ = 0;
};

}  // namespace knotwave::plugins
