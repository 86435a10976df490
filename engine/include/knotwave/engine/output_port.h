// SPDX-License-Identifier: MIT
// A MIDI cable with a byte budget: values that move in, as few messages as say them out, each at
// its time.
//
// A value is a step of its lane: 0..127 or 0..16383. A message is on the wire for its bytes and
// counts when its last byte has come. While the cable is free, a message is begun so that it has
// come when the value crosses to the next step (half way between two). While it is not, the newest
// value wins, and among lanes priority, then the one that waits longest; a controller that has
// waited 10 ms goes before the next bend or pressure. A receiver holds what it heard until it hears
// more: where a value runs faster than its messages, the mean of what it does meanwhile is sent,
// but for the lowest and the highest step that the lane has had, which are always reached (but see
// LaneSpec::rest_step), and the last value, which is always sent.
//
// What a value of 14 bits costs: the upper half, then the lower; the lower alone while the upper is
// the same; the upper alone while the lower was and is 0, which is how a value that runs by more
// than 256 steps a pair is sent. NRPN is the same through CC 6 and 38, with CC 99 and 98 before
// them unless the parameter is still selected, and CC 101 and 100 with 127 kNrpnNullSeconds after
// the last value. Figures: docs/envelope-generator.md.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "knotwave/base/midi_event.h"
#include "knotwave/base/result.h"
#include "knotwave/engine/envelope_patch.h"

namespace knotwave::engine {

inline constexpr double kDinBytesPerSecond = 3125;  ///< 31250 baud, 10 bits a byte (MIDI 1.0)
/// USB MIDI 1.0 at full speed: 16 events of 4 bytes fill a bulk packet of 64, and one packet goes
/// in a frame. No 17 events are begun within a frame's time, and none of a lane follows another
/// there.
inline constexpr double kUsbFrameSeconds = 0.001;
inline constexpr double kNrpnNullSeconds = 0.5;

struct OutputPortConfig {
  PortSpec::Wire wire = PortSpec::Wire::none;
  bool running_status = true;  ///< counted on; with Wire::din alone
  double rate_hz = 48000;
};

/// One value on the cable.
struct LaneSpec {
  OutputKind kind = OutputKind::control;  ///< of MIDI
  int channel = 1;                        ///< 1..16
  int number = 0;
  int key = 60;  ///< poly_pressure
  int bits = 7;
  int first_step = 0;  ///< what the receiver is taken to hold; -1: nobody knows, so it is sent
  /// What needs no message to a receiver that was told nothing yet, if the value left it before the
  /// first message came; -1: there is none.
  int rest_step = -1;
};

/// The order in which what waits goes out.
enum class OutputPriority : std::uint8_t { clock, note, expression, control };

/// What an owner shows.
struct PortCounters {
  std::int64_t messages = 0;
  std::int64_t bytes = 0;           ///< on the wire, running status counted
  std::int64_t thru_bytes = 0;      ///< of them those that were passed through
  std::int64_t overload_bytes = 0;  ///< thru that came while more than 20 ms of it waited
  double most_waiting_s = 0;        ///< of a thru message
  std::int64_t lost = 0;            ///< messages for which there was no room
  double use = 0;                   ///< 0..1 of the budget, over the last second; 0: no budget
};

/// Takes what an output port sends. [audio]
class PortSink {
 public:
  /// Complete messages in order of time; `event.time` is when the first byte goes out.
  virtual void send(const base::MidiEvent& event) KNOTWAVE_RT = 0;

 protected:
  ~PortSink() = default;
};

class OutputPort {
 public:
  static constexpr int kMostLanes = 512;
  static constexpr std::size_t kMostWaiting = 1024;  ///< messages; more are lost and counted
  static constexpr std::size_t kEndings = 1024;      ///< beyond, for controllers that end notes
  static constexpr std::size_t kNoteOffs = 4096;     ///< beyond, for ends of notes that were taken

  /// [control] Errors: value_out_of_range.
  static Result<std::unique_ptr<OutputPort>> create(const OutputPortConfig& config);
  ~OutputPort();

  /// [control] Its number. bits is 14 for pitch bend and 7 for pressures, whatever the spec says.
  /// Errors: value_out_of_range (also more than kMostLanes).
  Result<int> add_lane(const LaneSpec& spec);
  /// Which key or channel a lane is about from a sample on that has not been rendered (a voice was
  /// given another note). The value of that sample is there by then if the call comes a message
  /// before. [audio]
  void address(int lane, int channel, int key, std::int64_t from) KNOTWAVE_RT;

  /// How far after a block's end values must be known: what a message takes on the wire and the
  /// next one after it (a USB frame; a sample), and 3 samples, of the lanes so far. [any]
  std::size_t ahead_samples() const KNOTWAVE_RT;

  /// A message that must go out, before lanes of lower priority: notes, clock, thru. Times rise.
  /// All but clocks keep their order, so one is as urgent as the most urgent behind it. False:
  /// kMostWaiting were waiting (kEndings more for controllers that end notes), it is lost; so is
  /// the end of a note whose beginning was. The end of one that was taken is always taken, for two
  /// beginnings of a key, behind "all notes off" too. System exclusive is kept by reference until
  /// it is sent. Controllers that change what a lane's receiver holds (its other half, CC 6, 38, 96
  /// to 101, 121) are minded: the lane says it again. [audio]
  bool post(const base::MidiEvent& event, OutputPriority priority, bool is_thru) KNOTWAVE_RT;

  /// The values of one lane over a block: steps, unrounded; [n + ahead_samples()]. Empty: it holds.
  /// Clamped to the lane's steps, NaN is 0.
  using LaneValues = std::span<const double>;
  /// Everything that begins within samples first..first+n-1. lanes[i] belongs to lane i. [audio]
  /// Any split gives the same messages. About n operations a lane that moves, and one a lane that
  /// holds; a few a lane for each message.
  void render(std::int64_t first, std::size_t n, std::span<const LaneValues> lanes,
              PortSink& sink) KNOTWAVE_RT;

  /// The receiver is a new one, or came back: every lane's value is sent to it again. [audio]
  void say_again() KNOTWAVE_RT;
  /// What the receiver of one lane holds is unknown: another lane spoke there.
  void say_again(int lane) KNOTWAVE_RT;

  int last_step(int lane) const KNOTWAVE_RT;  ///< what was sent last
  bool is_waiting() const
      KNOTWAVE_RT;  ///< something has not been sent yet, or a parameter is selected
  const PortCounters& counters() const KNOTWAVE_RT;
  std::int64_t lane_bytes(int lane) const KNOTWAVE_RT;

 private:
  struct State;
  explicit OutputPort(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace knotwave::engine
