// SPDX-License-Identifier: MIT
// The instrument as every plugin format has it: a patch or bank, parameters, events of a block at
// their samples. An adapter turns its host's words into these calls and has no state of its own.
#pragma once
#include <array>
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
#include "knotwave/plugins/parameter_values.h"
#include "knotwave/plugins/plugin.h"

namespace knotwave::plugins {

struct InstrumentConfig {
  int max_voices = 128;
};

class Instrument final : public Plugin {
 public:
  /// Room for a block's events. Where more come, the block is rendered in parts; of those at one
  /// sample the rest is played a sample later, of those at the last sample with the next block.
  static constexpr std::size_t kEventsAtOnce = 2048;

  static const ParameterTable& table();  ///< [any] made at the first call

  /// [control] Plays the first factory preset. Compiles nothing yet.
  explicit Instrument(const InstrumentConfig& config = {});
  ~Instrument() override;
  const PluginInfo& info() const override;

  // While active the new sound begins with the next block, and sounding notes go over.

  /// A factory preset (factory.h). Parameters stay.
  Result<void> load_preset(std::size_t number) override;
  /// A patch or bank on the disk. Parameters stay. Errors: those of engine::read_bank() and
  /// BankProgram::create(); unsupported (a patch with a wave_file: plugins read no sounds).
  Result<void> load_file(const std::string& path) override;
  /// Errors: those of engine::read_journal(), unknown_name (a parameter), malformed, and of the
  /// patch inside.
  Result<void> load_state(std::string_view text) override;
  /// The patch or bank with every file it needs and the parameters that were moved, as a journal of
  /// what happens at time 0 (docs/journal-format.md), which knotwave-render --journal reads too.
  std::string state() const override;
  const std::string& name() const { return spec_.name; }  ///< of the patch or bank

  Result<void> activate(double rate_hz) override;
  void deactivate() override;
  bool is_active() const override { return live_ != nullptr; }
  void collect() override;

  void set_parameter(std::size_t place, double value) KNOTWAVE_RT override;
  double parameter(std::size_t place) const KNOTWAVE_RT override;

  void begin(const Block& block) KNOTWAVE_RT override;
  /// The same, of two channels.
  void begin(std::span<float> left, std::span<float> right) KNOTWAVE_RT;
  void add(const engine::Event& event) KNOTWAVE_RT override;
  /// From that sample on (over engine::kTargetGlideSeconds).
  void add_parameter(std::size_t place, double value, std::int64_t sample) KNOTWAVE_RT override;
  /// Of one note it glides within the note's own slots (engine::Event::Kind::set_note).
  void add_modulation(std::size_t place, double amount, const NoteAddress& notes,
                      std::int64_t sample) KNOTWAVE_RT override;
  std::span<const engine::EndedNote> ended_notes() const KNOTWAVE_RT override {
    return std::span(ended_).first(ended_count_);
  }
  void forget_ended_notes() KNOTWAVE_RT override { ended_count_ = 0; }
  /// A tempo that is in force costs nothing. The song's position is told to the engine where the
  /// song begins to play and where it jumps (by more than 1/1000 of a quarter note), at the next
  /// 1/24 of a quarter note, to a 2^-32 of a sample.
  void add_transport(const Transport& transport, std::int64_t sample) KNOTWAVE_RT override;
  void render() KNOTWAVE_RT override;
  void reset() KNOTWAVE_RT override;
  bool is_idle() const KNOTWAVE_RT override;
  /// A patch may sound on for ever; is_idle() says when it does not.
  std::int64_t tail_samples() const KNOTWAVE_RT override { return kEndless; }

 private:
  Result<void> load(engine::BankSpec spec);
  void render_until(std::size_t sample) KNOTWAVE_RT;
  void push(const engine::Event& event) KNOTWAVE_RT;
  void push_parameter(std::size_t place, std::int64_t sample) KNOTWAVE_RT;
  void place(const engine::Event& event) KNOTWAVE_RT;
  void place_song() KNOTWAVE_RT;
  void follow_song(const Transport& transport, std::int64_t sample) KNOTWAVE_RT;

  InstrumentConfig config_;
  engine::BankSpec spec_;
  std::unique_ptr<const engine::BankProgram> program_;  ///< compiled and not yet played
  std::unique_ptr<engine::LiveEngine> live_;

  ParameterValues values_{table()};

  // The audio thread.
  std::vector<engine::Event> events_;  ///< [kEventsAtOnce]
  std::size_t event_count_ = 0;
  std::array<double, ParameterValues::kMost> modulation_{};  ///< of every note
  std::vector<engine::EndedNote> ended_;
  std::size_t ended_count_ = 0;
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
