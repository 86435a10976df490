// SPDX-License-Identifier: MIT
// The envelope generator whole, on a virtual clock: MIDI in, patches that play, cables that send.
// Exact in tests and offline; live a thread calls advance() with the time that has come.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "knotwave/base/midi_event.h"
#include "knotwave/base/result.h"
#include "knotwave/engine/envelope_patch_program.h"
#include "knotwave/engine/envelope_player.h"
#include "knotwave/engine/output_port.h"

namespace knotwave::engine {

struct EnvelopeGeneratorConfig {
  double rate_hz = 48000;  ///< of the virtual clock
  std::uint64_t seed = 1;
  bool thru = false;  ///< all that comes in goes out again, merged, to the first port
  double bpm = 120;   ///< until a clock or a tempo says another
};

/// What the generator sends. All [audio].
class GeneratorSink {
 public:
  /// `port` as ports() numbers them.
  virtual void midi(int port, const base::MidiEvent& event) KNOTWAVE_RT = 0;
  /// A number for the OSC address of an output.
  virtual void osc(int patch, int output, base::SampleTime time, double value) KNOTWAVE_RT = 0;

 protected:
  ~GeneratorSink() = default;
};

/// One output, for those who show it.
struct RouteStatus {
  int patch = 0, output = 0;
  int port = -1;     ///< -1: OSC or voltage
  double value = 0;  ///< last sent, in the output's unit
  double bytes_per_second = 0;
  double share = 0;  ///< of the port's budget; 0: none
};

class EnvelopeGenerator {
 public:
  /// [control] The programs must outlive it. Ports of one name are one port: what the patches say
  /// of it must agree. Errors: value_out_of_range, control_conflict (two outputs onto one
  /// destination, two ports of one name that differ), capacity.
  static Result<std::unique_ptr<EnvelopeGenerator>> create(
      const EnvelopeGeneratorConfig& config, std::span<const EnvelopePatchProgram* const> patches);
  ~EnvelopeGenerator();

  const std::vector<PortSpec>& ports() const;  ///< [control]

  /// In order of time, none before now(). MIDI clock, start, stop and song position set the tempo
  /// and the position. [audio]
  void handle(const base::MidiEvent& event) KNOTWAVE_RT;
  void set_tempo(base::SampleTime time, std::uint32_t microseconds_per_quarter) KNOTWAVE_RT;
  /// Plays up to sample `until`: all that begins before it is sent. [audio]
  void advance(std::int64_t until, GeneratorSink& sink) KNOTWAVE_RT;
  /// Closes the gates, ends the notes it sent and brings every destination to its rest value, as
  /// fast as the cables let it. advance() goes on until is_at_rest(). [audio]
  void go_to_rest() KNOTWAVE_RT;
  bool is_at_rest() const KNOTWAVE_RT;

  std::int64_t now() const KNOTWAVE_RT;
  const PortCounters& port_counters(int port) const KNOTWAVE_RT;
  std::vector<RouteStatus> routes() const;  ///< [control] by the thread that calls advance()

 private:
  struct State;
  explicit EnvelopeGenerator(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace knotwave::engine
