// SPDX-License-Identifier: MIT
// One lane of an output port: what its receiver holds, when that is to change, and to what. All
// [audio].
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "knotwave/engine/output_port.h"

#include "cable.h"
#include "lane_curve.h"

namespace knotwave::engine {

/// The messages that say one value: up to CC 99, 98, 6, 38. Nothing that a receiver could take for
/// a part of it comes between them.
struct MessageGroup {
  std::array<base::MidiEvent, 4> messages;
  int count = 0;

  void add(int status, int channel, int data_1, int data_2) KNOTWAVE_RT {
    base::MidiEvent& event = messages[static_cast<std::size_t>(count++)];
    event.bytes[0] = static_cast<std::uint8_t>(status + channel - 1);
    event.bytes[1] = static_cast<std::uint8_t>(data_1);
    event.bytes[2] = static_cast<std::uint8_t>(data_2);
  }
};

/// What registered or other parameter a channel's data entry goes to.
struct ParameterSelection {
  int nrpn = -1;  ///< that we selected and nobody changed; -1: none
  Ticks null_at = kNever;
};
using Selections = std::array<ParameterSelection, 16>;

class OutputLane {
 public:
  explicit OutputLane(const LaneSpec& spec);

  const LaneSpec& spec() const KNOTWAVE_RT { return spec_; }
  bool is_expression() const KNOTWAVE_RT;
  int sent() const KNOTWAVE_RT { return sent_; }
  bool is_waiting() const KNOTWAVE_RT;
  /// When the value left what the receiver holds; kNever: not within what is known.
  Ticks left_at() const KNOTWAVE_RT { return left_at_; }
  /// When to begin so that it has come by then.
  Ticks due(const Cable& cable, const Selections& selections) const KNOTWAVE_RT;
  /// Bytes of the longest group, each with its status.
  std::int64_t most_bytes() const KNOTWAVE_RT;
  /// A message of the same lane that follows one, at most.
  std::int64_t most_next_bytes() const KNOTWAVE_RT;

  void address(int channel, int key, std::int64_t from) KNOTWAVE_RT;
  /// Something went by that changes a half of what the receiver holds, or all of it.
  void forget_halves() KNOTWAVE_RT { high_half_ = low_half_ = -1; }
  /// What the receiver holds is unknown from `time` on; `now` is when that began.
  void forget(Ticks now, Ticks time, Ticks until) KNOTWAVE_RT;
  /// It is forgotten with the next block.
  void say_again() KNOTWAVE_RT { must_say_again_ = true; }
  bool must_say_again() const KNOTWAVE_RT { return must_say_again_; }
  /// New samples: looks for the next change up to `until`.
  void begin_block(std::int64_t first, std::span<const double> values, Ticks until) KNOTWAVE_RT;
  void end_block(std::int64_t n) KNOTWAVE_RT;

  struct Plan {
    int step = 0;
    Ticks arrival = 0, hold_end = 0;
  };
  /// What to send if it begins at `begin`; nothing: what the receiver holds is as good, and the
  /// lane waits for another change.
  std::optional<Plan> plan(Ticks begin, Ticks until, const Cable& cable,
                           const Selections& selections) KNOTWAVE_RT;
  /// The next change is looked for later than the one there is: a plan that came to nothing and
  /// left it where it was would be made for ever.
  void pass_over(Ticks until) KNOTWAVE_RT;
  MessageGroup messages(int step, const Selections& selections) const KNOTWAVE_RT;
  /// Its message begins.
  void begin(const Plan& plan, Ticks time, Ticks until, const Cable& cable) KNOTWAVE_RT;
  /// Its last byte comes at `time`, as planned or later. On DIN alone, where others go between.
  void arrives(Ticks time, Ticks until) KNOTWAVE_RT;

 private:
  /// The lowest or the highest step that the value has reached: what is owed to the receiver.
  struct Extreme {
    int step = -1;  ///< -1, for a low one also above all: none yet
    Ticks owed_since = kNever;
    Ticks from = 0;  ///< what was before does not count
  };
  struct Extremes {
    Extreme low, high;
    bool has_left_rest = false;
  };

  bool is_owed(int step, bool has_left_rest, Ticks time) const KNOTWAVE_RT;
  void is_told_from(Ticks time) KNOTWAVE_RT;
  bool is_held(int step, int direction, Ticks time, Ticks until) const KNOTWAVE_RT;
  bool is_nrpn() const KNOTWAVE_RT { return spec_.kind == OutputKind::nrpn; }
  bool has_halves() const KNOTWAVE_RT;
  double band_low() const KNOTWAVE_RT;
  double band_high() const KNOTWAVE_RT;
  void find_change(Ticks from, Ticks until) KNOTWAVE_RT;
  void wait_from(Ticks arrival, Ticks until) KNOTWAVE_RT;
  void leaves_at(Ticks time) KNOTWAVE_RT;
  Ticks cost(int step, const Cable& cable, const Selections& selections) const KNOTWAVE_RT;
  Plan mean_plan(Ticks arrival, const Cable& cable) const KNOTWAVE_RT;
  Ticks hold(Ticks arrival, const Cable& cable) const KNOTWAVE_RT;
  std::optional<Plan> coarse_plan(Ticks arrival, const Cable& cable) const KNOTWAVE_RT;
  void see_until(Ticks now, Ticks held_until) KNOTWAVE_RT;
  void reach(Extremes& extremes, std::int64_t from_sample, std::int64_t to_sample,
             Ticks held_until) const KNOTWAVE_RT;
  void note_extreme(Extremes& all, Extreme& extreme, int step, int direction, Ticks time,
                    Ticks held_until) const KNOTWAVE_RT;
  std::optional<int> owed_step(const Extremes& reached, Ticks hold_end) const KNOTWAVE_RT;

  LaneSpec spec_;
  int top_ = 127;
  int sent_ = 0;  ///< -1: nobody knows
  int sent_before_ = -1;
  int high_half_ = -1, low_half_ = -1;
  Ticks told_from_ = 0;  ///< the first message since nobody knew has come
  Ticks arrived_ = 0;    ///< when what was sent last was there, as far as is known
  bool is_on_its_way_ = false;
  Ticks not_before_ = 0;
  Ticks left_at_ = kNever;
  int next_step_ = 0;            ///< what it goes to then
  Ticks begins_not_before_ = 0;  ///< what is said then is shorter than next_step_
  bool has_value_ = false, has_begun_ = false, must_say_again_ = false;
  LaneCurve curve_;
  Extremes extremes_;
  std::int64_t seen_ = -1;           ///< the last sample that extremes_ knows
  std::int64_t addressed_from_ = 0;  ///< what came before was about another channel or key
};

}  // namespace knotwave::engine
