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
#include "knotwave/engine/midi_clock.h"
#include "knotwave/engine/output_port.h"

namespace knotwave::engine {

struct EnvelopeGeneratorConfig {
  double rate_hz = 48000;  ///< of the virtual clock
  std::uint64_t seed = 1;
  bool thru = false;  ///< all that comes in goes out again, merged, to the first port
  double bpm = 120;   ///< until a clock or a tempo says another
  /// Patches play ahead of the cables by as much (0..0.05), rounded down to samples: a message that
  /// must begin before the event which causes it, so that it has come in time, does so. Who plays
  /// live sends what begins at s at s plus a delay of at least this. 0.97 ms covers a controller on
  /// a DIN cable.
  double lead_s = 0.001;
};

/// What the generator sends. All [audio].
class GeneratorSink {
 public:
  /// `port` as ports() numbers them.
  virtual void midi(int port, const base::MidiEvent& event) KNOTWAVE_RT = 0;
  /// A number for the OSC address of an output.
  virtual void osc(int patch, int output, base::SampleTime time, double value) KNOTWAVE_RT = 0;
  /// Volts of an audio channel (from 0) at samples first.. of the patches, lead_s ahead of MIDI: of
  /// each channel up to the highest that a patch names, at most 64 samples at a time.
  virtual void volts(int /*channel*/, std::int64_t /*first*/,
                     std::span<const double> /*values*/) KNOTWAVE_RT {}

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
  /// of it must agree. Outputs of patches whose [trigger] programs differ may share a destination:
  /// the one that played last has it. Errors: value_out_of_range, control_conflict (two outputs
  /// onto one destination, two ports of one name that differ).
  static Result<std::unique_ptr<EnvelopeGenerator>> create(
      const EnvelopeGeneratorConfig& config, std::span<const EnvelopePatchProgram* const> patches);
  ~EnvelopeGenerator();

  const std::vector<PortSpec>& ports() const;  ///< [control] one without a name: our own
  std::size_t voltage_channels() const;        ///< [control] up to the highest a patch names

  /// In order of time; one before now() is heard now. It acts when advance() comes there. MIDI
  /// clock, start, stop and song position set the tempo and the position. False: kMostEvents wait
  /// (kMostEndings more where it ends notes), it is lost. System exclusive is kept by reference
  /// until it is sent. [audio]
  bool handle(const base::MidiEvent& event) KNOTWAVE_RT;
  bool set_tempo(base::SampleTime time, std::uint32_t microseconds_per_quarter) KNOTWAVE_RT;
  /// The same of any event: what a player of envelopes hears of it is in envelope_player.h.
  bool tell(const Event& event) KNOTWAVE_RT;
  static constexpr std::size_t kMostEvents = 8192;
  static constexpr std::size_t kMostEndings = 2048;
  /// Plays up to sample `until`: all that cables begin before `until` - lead_s is sent, in order of
  /// time for each port, and OSC before `until`. Any split gives the same. [audio]
  void advance(std::int64_t until, GeneratorSink& sink) KNOTWAVE_RT;
  /// Who hears a port is new, or came back: every value is sent there again. [audio]
  void say_again(int port) KNOTWAVE_RT;
  /// Closes the gates, ends the notes it sent and brings every destination to its rest value, as
  /// fast as the cables let it; what is handled from then on is left out. advance() goes on until
  /// is_at_rest(). [audio]
  void go_to_rest() KNOTWAVE_RT;
  bool is_at_rest() const KNOTWAVE_RT;
  /// Ends the notes it sent and every envelope at once, and plays on: outputs go to their rest
  /// values until a gate opens. What was handled and not yet heard is left out. [audio]
  void end_all() KNOTWAVE_RT;

  /// Nothing is sent until something is handled, however far advance() goes. LFOs, clocks and loops
  /// never stand still, and a gate that is open does not. [audio]
  bool is_still() const KNOTWAVE_RT;

  std::int64_t now() const KNOTWAVE_RT;   ///< of the patches
  std::int64_t lost() const KNOTWAVE_RT;  ///< what handle() had no room for
  MidiClockStatus clock_status() const KNOTWAVE_RT;
  const PortCounters& port_counters(int port) const KNOTWAVE_RT;
  std::vector<RouteStatus> routes() const;  ///< [control] by the thread that calls advance()

 private:
  struct State;
  explicit EnvelopeGenerator(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace knotwave::engine
