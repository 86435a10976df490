// SPDX-License-Identifier: MIT
// What every plugin is to every format. An adapter (clap/, dpf/) turns its host's words into these
// calls and knows no plugin by name; a plugin knows no format.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "knotwave/base/midi_event.h"
#include "knotwave/base/result.h"
#include "knotwave/engine/engine.h"
#include "knotwave/engine/event.h"
#include "knotwave/plugins/parameters.h"

namespace knotwave::plugins {

struct AudioPort {
  std::string_view name;  ///< "Input"
  int channels = 2;
  /// Control voltage, 1.0 = 10 V. Only formats that have such ports show it, behind all others.
  bool is_voltage = false;
};

class Plugin;

/// All that a host is told before there is one. Keys stay for ever: hosts keep them in sessions.
struct PluginInfo {
  enum class Kind { instrument, distortion, mixer, filter, note_effect };  ///< menus of hosts
  std::string_view key;   ///< "shaper": CLAP org.knotwave.shaper, LV2 urn:knotwave:shaper
  std::string_view name;  ///< "Knotwave Shaper"
  std::string_view description;
  std::span<const AudioPort> inputs, outputs;  ///< the first of each is the main one
  Kind kind = Kind::instrument;
  bool takes_midi = false;
  bool gives_midi = false;
  const ParameterTable* parameters = nullptr;
  std::span<const std::string> presets;  ///< names
  std::unique_ptr<Plugin> (*create)() = nullptr;
};

/// Of the host, at one sample of a block.
struct Transport {
  double beats_per_minute = 0;  ///< quarter notes; 0: not known
  double quarters = 0;          ///< since the song's start
  bool is_playing = false;      ///< the song runs
  bool has_position = false;    ///< `quarters` is known
};

/// Which of the notes that sound: that of a number the host gave it, or those of a channel and a
/// key. -1: any.
struct NoteAddress {
  std::int32_t note = -1;
  int channel = -1, key = -1;

  bool is_every() const KNOTWAVE_RT { return note < 0 && channel < 0 && key < 0; }
};

/// A block's channels, those of all ports one after the other. `out` may be `in`, channel for
/// channel. A channel a format does not show is null: an input of zeros, an output nobody hears.
struct Block {
  static constexpr std::size_t kMostChannels = 16;  ///< of all inputs, of all outputs
  std::span<const float* const> in;
  std::span<float* const> out;
  std::size_t frames = 0;
};

class Plugin {
 public:
  virtual ~Plugin() = default;
  virtual const PluginInfo& info() const = 0;

  // What it plays. All [control]; each all or nothing: after an error everything is as it was.

  /// Errors: value_out_of_range, those of load_state().
  virtual Result<void> load_preset(std::size_t number) = 0;
  /// What state() gave, of this version or an older one.
  virtual Result<void> load_state(std::string_view text) = 0;
  virtual std::string state() const = 0;
  /// What load_state() takes, from the disk; an instrument takes patches and banks instead. Errors:
  /// those of base::read_file() too.
  virtual Result<void> load_file(const std::string& path);

  /// [control] Time 0, nothing sounds. Rate 8000..768000 Hz. Errors: value_out_of_range.
  virtual Result<void> activate(double rate_hz) = 0;
  virtual void deactivate() = 0;  ///< [control]
  virtual bool is_active() const = 0;
  /// Frees what was replaced. Now and then. [control]
  virtual void collect() {}

  /// [any] Heard from the next block on; held within its range, NaN is its initial value.
  virtual void set_parameter(std::size_t place, double value) KNOTWAVE_RT = 0;
  virtual double parameter(std::size_t place) const KNOTWAVE_RT = 0;  ///< [any]

  // A block. All [audio], while active: begin(), what happens in order of time, render().

  virtual void begin(const Block& block) KNOTWAVE_RT = 0;
  /// `event.time()` counts from the block's first sample. Of any kind but install_bank. System
  /// exclusive is kept by reference until render().
  virtual void add(const engine::Event& event) KNOTWAVE_RT = 0;
  virtual void add_parameter(std::size_t place, double value, std::int64_t sample) KNOTWAVE_RT = 0;
  /// Beside the parameter's value, of some notes or of all; not kept in the state. Of instruments.
  virtual void add_modulation(std::size_t, double, const NoteAddress&, std::int64_t) KNOTWAVE_RT {}
  /// Once a block, or where it changes.
  virtual void add_transport(const Transport& transport, std::int64_t sample) KNOTWAVE_RT = 0;
  virtual void render() KNOTWAVE_RT = 0;
  /// MIDI of the block, in order of time, from render() to the next begin().
  virtual std::span<const base::MidiEvent> midi_out() const KNOTWAVE_RT { return {}; }
  /// Notes that are heard no more, since begin() or forget_ended_notes(). Where more than a block's
  /// events come, they are to be asked for after each event: the block is rendered in parts then.
  virtual std::span<const engine::EndedNote> ended_notes() const KNOTWAVE_RT { return {}; }
  virtual void forget_ended_notes() KNOTWAVE_RT {}
  /// Every note and every tail ends at once. Parameters and controllers stay.
  virtual void reset() KNOTWAVE_RT = 0;
  /// Silent until something comes in.
  virtual bool is_idle() const KNOTWAVE_RT = 0;
  /// While it is idle nothing in it goes on: what comes later sounds the same whether it was played
  /// until then or not, so a host may stop to. Not where noise, clocks or followers run.
  virtual bool may_sleep() const KNOTWAVE_RT { return false; }

  static constexpr std::int64_t kEndless = -1;
  /// How long it may sound behind its last input. [any]
  virtual std::int64_t tail_samples() const KNOTWAVE_RT { return 0; }
};

}  // namespace knotwave::plugins
