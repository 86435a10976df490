// SPDX-License-Identifier: MIT
// Knotwave Envelope: the envelope generator in a host. MIDI in and a side chain open its gates;
// MIDI and control voltages go out at the sample at which a curve comes to them, without latency.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/base/hand_over.h"
#include "knotwave/engine/envelope_generator.h"
#include "knotwave/plugins/parameter_values.h"
#include "knotwave/plugins/plugin.h"

#include "host_song.h"
#include "side_chain_gate.h"

namespace knotwave::plugins {

class EnvelopePlugin final : public Plugin, private engine::GeneratorSink {
 public:
  /// Places of parameters. They stay for ever.
  enum Place : std::size_t {
    time,
    rate,
    source,
    velocity,
    gate,
    threshold,
    hysteresis,
    hold,
    first_depth,
    first_offset = first_depth + 8,
    first_macro = first_offset + 8,
  };
  enum class GateSource { patch, side_chain, song, hand };
  static constexpr std::size_t kAudioChannels = 2;  ///< of the side chain and of its way through
  static constexpr std::size_t kVoltages = 8;
  static constexpr double kVoltsFullScale = 10;
  /// MIDI of a block. What has no room is said again at the next, but for ends of notes, which have
  /// kKeptForEnds more.
  static constexpr std::size_t kMostMessages = 16384, kKeptForEnds = 4096;

  static const ParameterTable& table();

  EnvelopePlugin();
  ~EnvelopePlugin() override;
  const PluginInfo& info() const override { return envelope_info_; }

  /// Parameters stay.
  Result<void> load_preset(std::size_t number) override;
  /// A state, or a patch of the envelope generator that names no files (parameters stay). Errors,
  /// with line and column: those of base::parse_document() and engine::read_envelope_patch(),
  /// unsupported (another plugin's; an output to OSC or to an audio channel beyond kVoltages), and
  /// of what is wrong with parameters.
  Result<void> load_state(std::string_view text) override;
  std::string state() const override;

  Result<void> activate(double rate_hz) override;
  void deactivate() override;
  bool is_active() const override { return playing_ != nullptr; }
  void collect() override { arriving_.collect(); }

  void set_parameter(std::size_t place, double value) KNOTWAVE_RT override;
  double parameter(std::size_t place) const KNOTWAVE_RT override;

  void begin(const Block& block) KNOTWAVE_RT override;
  void add(const engine::Event& event) KNOTWAVE_RT override;
  void add_parameter(std::size_t place, double value, std::int64_t sample) KNOTWAVE_RT override;
  void add_transport(const Transport& transport, std::int64_t sample) KNOTWAVE_RT override;
  void render() KNOTWAVE_RT override;
  std::span<const base::MidiEvent> midi_out() const KNOTWAVE_RT override {
    return std::span(sent_).first(sent_count_);
  }
  /// What ends notes and brings values to rest goes out with the next block.
  void reset() KNOTWAVE_RT override;
  bool is_idle() const KNOTWAVE_RT override { return false; }
  std::int64_t tail_samples() const KNOTWAVE_RT override { return kEndless; }

 private:
  /// A patch that plays, from its own sample 0 on.
  struct Playing {
    std::unique_ptr<const engine::EnvelopePatchProgram> program;
    std::unique_ptr<engine::EnvelopeGenerator> generator;
  };
  static Result<std::unique_ptr<Playing>> make_playing(const engine::EnvelopePatchSpec& spec,
                                                       double rate_hz);
  Result<void> load(engine::EnvelopePatchSpec spec);

  void drop_arriving();
  void take_patch() KNOTWAVE_RT;
  void play_leaving() KNOTWAVE_RT;
  void play_until(std::int64_t sample) KNOTWAVE_RT;
  void tell(engine::Event event, std::int64_t sample) KNOTWAVE_RT;
  void tell(int slot, double number, std::int64_t sample) KNOTWAVE_RT;
  void tell_parameter(std::size_t place, double value, std::int64_t sample) KNOTWAVE_RT;
  void hear_side_chain(std::int64_t until) KNOTWAVE_RT;
  void follow_gate(std::int64_t sample) KNOTWAVE_RT;
  bool wants_gate() const KNOTWAVE_RT;
  void set_side_chain() KNOTWAVE_RT;
  GateSource gate_source() const KNOTWAVE_RT {
    return static_cast<GateSource>(static_cast<int>(values_.heard(source)));
  }
  void pass_through() KNOTWAVE_RT;
  void say_again() KNOTWAVE_RT;

  void midi(int port, const base::MidiEvent& event) KNOTWAVE_RT override;
  void osc(int, int, base::SampleTime, double) KNOTWAVE_RT override {}
  void volts(int channel, std::int64_t first, std::span<const double> values) KNOTWAVE_RT override;

  const PluginInfo& envelope_info_;
  engine::EnvelopePatchSpec spec_;  ///< [control]
  double rate_hz_ = 48000;
  ParameterValues values_{table()};
  base::HandOver<Playing> arriving_;

  // The audio thread.
  Playing* playing_ = nullptr;
  Playing* leaving_ = nullptr;  ///< goes to rest
  std::int64_t leaves_until_ = 0;
  Block block_;
  std::int64_t now_ = 0;        ///< the block's first sample, since activate()
  std::int64_t base_ = 0;       ///< the same on the clock of playing_
  std::int64_t sink_base_ = 0;  ///< and of the one that advances
  std::int64_t played_ = 0;     ///< samples of this block that are played
  std::size_t told_ = 0;        ///< events since then
  std::int64_t listened_ = 0;
  bool is_leaving_ = false;      ///< leaving_ advances
  bool must_say_again_ = false;  ///< with the next block
  HostSong song_;
  SideChainGate side_chain_;
  bool gate_is_open_ = false;  ///< as the generator knows it
  std::vector<base::MidiEvent> sent_;
  std::size_t sent_count_ = 0;
};

}  // namespace knotwave::plugins
