// SPDX-License-Identifier: MIT
// When a lane changes and to what.
#include "output_lane.h"

namespace knotwave::engine {
namespace {

/// Beyond half way between two steps by as much, so that rounding of a value that stands there
/// makes no messages.
constexpr double kMargin = 1e-9;
/// A value of 14 bits that runs by more while a pair of messages holds is sent by its upper half.
constexpr double kFastRange = 256;

/// Steps the value is truly within, not at the edge of.
int step_reached_below(double v) { return static_cast<int>(std::floor(v + 0.5 + kMargin)); }
int step_reached_above(double v) { return static_cast<int>(std::ceil(v - 0.5 - kMargin)); }
int nearest_step(double v) { return static_cast<int>(std::floor(v + 0.5)); }

}  // namespace

OutputLane::OutputLane(const LaneSpec& spec)
    : spec_(spec), top_(spec.bits == 14 ? 16383 : 127), sent_(spec.first_step) {
  curve_.top = top_;
}

bool OutputLane::has_halves() const KNOTWAVE_RT {
  return spec_.bits == 14 && (spec_.kind == OutputKind::control || is_nrpn());
}
bool OutputLane::is_expression() const KNOTWAVE_RT {
  return spec_.kind == OutputKind::pitch_bend || spec_.kind == OutputKind::channel_pressure ||
         spec_.kind == OutputKind::poly_pressure;
}
double OutputLane::band_low() const KNOTWAVE_RT {
  return sent_ < 0 ? std::numeric_limits<double>::infinity() : sent_ - 0.5 - kMargin;
}
double OutputLane::band_high() const KNOTWAVE_RT { return sent_ + 0.5 + kMargin; }

bool OutputLane::is_waiting() const KNOTWAVE_RT {
  if (!has_value_) return false;
  const double v = curve_.before[1];
  return v < band_low() || v > band_high() || extremes_.low.owed_since != kNever ||
         extremes_.high.owed_since != kNever;
}

std::int64_t OutputLane::most_bytes() const KNOTWAVE_RT {
  return is_nrpn() ? (has_halves() ? 12 : 9) : most_next_bytes();
}
std::int64_t OutputLane::most_next_bytes() const KNOTWAVE_RT {
  return has_halves() ? 6 : spec_.kind == OutputKind::channel_pressure ? 2 : 3;
}

void OutputLane::address(int channel, int key, std::int64_t from) KNOTWAVE_RT {
  const bool is_same =
      spec_.channel == channel && (spec_.key == key || spec_.kind != OutputKind::poly_pressure);
  if (is_same && has_begun_) return;
  spec_.channel = channel;
  spec_.key = key;
  extremes_ = {};
  forget_halves();
  sent_ = sent_before_ = -1;
  has_begun_ = true;
  arrived_ = not_before_ = sample_ticks(from);
  left_at_ = kNever;
  addressed_from_ = from;
}

void OutputLane::forget(Ticks now, Ticks time, Ticks until) KNOTWAVE_RT {
  if (has_value_) see_until(now, kNever);
  forget_halves();
  sent_ = sent_before_ = -1;
  must_say_again_ = false;
  if (!has_value_) return;
  arrived_ = not_before_ = std::max(time, arrived_);
  find_change(arrived_, until);
}

MessageGroup OutputLane::messages(int step, const Selections& selections) const KNOTWAVE_RT {
  MessageGroup group;
  const int channel = spec_.channel;
  const int high = step >> 7, low = step & 127;
  switch (spec_.kind) {
    case OutputKind::pitch_bend:
      group.add(0xE0, channel, low, high);
      return group;
    case OutputKind::channel_pressure:
      group.add(0xD0, channel, step, 0);
      return group;
    case OutputKind::poly_pressure:
      group.add(0xA0, channel, spec_.key, step);
      return group;
    default:
      break;
  }
  const bool is_selected =
      !is_nrpn() || selections[static_cast<std::size_t>(channel - 1)].nrpn == spec_.number;
  if (!is_selected) {
    group.add(0xB0, channel, 99, spec_.number >> 7);
    group.add(0xB0, channel, 98, spec_.number & 127);
  }
  const int number = is_nrpn() ? 6 : spec_.number;
  if (!has_halves()) {
    group.add(0xB0, channel, number, step);
    return group;
  }
  // An upper half resets the lower one to 0, says MIDI 1.0, but not every receiver does. Both kinds
  // agree where the lower half follows, and where it was 0 and is to be 0.
  const bool sends_high = !is_selected || high != high_half_;
  const bool sends_low = sends_high ? !is_selected || low != 0 || low_half_ != 0 : true;
  if (sends_high) group.add(0xB0, channel, number, high);
  if (sends_low) group.add(0xB0, channel, number + 32, low);
  return group;
}

Ticks OutputLane::cost(int step, const Cable& cable,
                       const Selections& selections) const KNOTWAVE_RT {
  if (!cable.is_din()) return 0;
  const MessageGroup group = messages(step, selections);
  std::int64_t bytes = cable.bytes_now(group.messages[0]);
  for (int i = 1; i < group.count; ++i) {
    bytes += message_bytes(group.messages[static_cast<std::size_t>(i)]) -
             (cable.has_running_status() ? 1 : 0);
  }
  return cable.time_of_bytes(bytes);
}

void OutputLane::begin_block(std::int64_t first, std::span<const double> values,
                             Ticks until) KNOTWAVE_RT {
  curve_.first = first;
  curve_.values = values;
  if (!has_value_) {
    if (values.empty()) return;
    curve_.before[0] = curve_.before[1] = curve_.sample(first);
    has_value_ = true;
    seen_ = first - 1;
  }
  if (!has_begun_) {
    has_begun_ = true;
    arrived_ = not_before_ = sample_ticks(first);
    left_at_ = kNever;
  }
  // What left before the last sample is certain; what was only foreseen is looked for again.
  if (left_at_ > sample_ticks(first - 1)) find_change(sample_ticks(first - 1), until);
}

void OutputLane::find_change(Ticks from, Ticks until) KNOTWAVE_RT {
  const Ticks start = std::max(from, not_before_);
  leaves_at(curve_.leaves(band_low(), band_high(), start, until));
  if (sent_ < 0 || start > until || left_at_ == start) return;
  // An extreme that came and went while the lane could not speak.
  Extremes reached = extremes_;
  reach(reached, seen_ + 1, start >> kTickBits, kNever);
  if (reached.low.owed_since != kNever || reached.high.owed_since != kNever) leaves_at(start);
}

/// The value of then is looked at now: later it is over.
void OutputLane::leaves_at(Ticks time) KNOTWAVE_RT {
  if (time != left_at_) begins_not_before_ = 0;
  left_at_ = time;
  if (time == kNever) return;
  const double v = curve_.at(time);
  const int step = sent_ < 0 ? nearest_step(v) : v > sent_ ? sent_ + 1 : sent_ - 1;
  next_step_ = std::clamp(step, 0, top_);
}

void OutputLane::end_block(std::int64_t n) KNOTWAVE_RT {
  if (!has_value_) return;
  const std::int64_t last = curve_.first + n - 1;
  reach(extremes_, curve_.values.empty() ? last : seen_ + 1, last, kNever);
  seen_ = last;
  curve_.before[0] = curve_.sample(last - 1);
  curve_.before[1] = curve_.sample(last);
}

Ticks OutputLane::due(const Cable& cable, const Selections& selections) const KNOTWAVE_RT {
  if (left_at_ == kNever) return kNever;
  return std::max(left_at_ - cost(next_step_, cable, selections), begins_not_before_);
}

/// Until the next message of this lane can have come: while it runs, the shortest one that says
/// where it is by then.
Ticks OutputLane::hold(Ticks arrival, const Cable& cable) const KNOTWAVE_RT {
  if (!cable.is_din()) return cable.spacing();
  const std::int64_t status = cable.has_running_status() ? 1 : 0;
  const std::int64_t one = spec_.kind == OutputKind::channel_pressure ? 2 : 3;
  const Ticks shortest = cable.time_of_bytes(one - status);
  if (!has_halves()) return shortest;
  const int now = nearest_step(curve_.at(arrival)) >> 7;
  const bool is_near = nearest_step(curve_.at(arrival + shortest)) >> 7 == now;
  return is_near ? shortest : 2 * shortest;
}

std::optional<OutputLane::Plan> OutputLane::plan(Ticks begin, Ticks until, const Cable& cable,
                                                 const Selections& selections) KNOTWAVE_RT {
  const Ticks due_at = due(cable, selections);
  Ticks arrival = begin + (left_at_ - due_at);
  Plan made;
  for (int pass = 0; pass < 2; ++pass) {  // what is to be said says how long it takes
    made = mean_plan(arrival, cable);
    Extremes reached = extremes_;
    reach(reached, seen_ + 1, made.hold_end >> kTickBits, arrival);
    const double v = curve_.at(arrival);
    if (const auto owed = owed_step(reached, made.hold_end)) {
      made.step = *owed;
    } else if (begin != due_at && v >= band_low() && v <= band_high()) {
      if (arrival < left_at_) {  // an upper half alone would be there before the value leaves
        begins_not_before_ = left_at_ - (arrival - begin);
        return {};
      }
      wait_from(arrival, until);
      return {};
    }
    const Ticks arrives = begin + cost(made.step, cable, selections);
    if (arrives == arrival) break;
    arrival = made.arrival = arrives;
    made.hold_end = std::max(made.hold_end, arrives);
  }
  if (made.step != sent_) return made;
  // A message shorter than that of the next step holds up to where the value leaves, not beyond.
  not_before_ = std::max({not_before_, made.hold_end, left_at_ + kTicksPerSample});
  find_change(not_before_, until);
  return {};
}

void OutputLane::pass_over(Ticks until) KNOTWAVE_RT {
  not_before_ = std::max(not_before_, left_at_ + kTicksPerSample);
  find_change(not_before_, until);
}

/// The value is back where the receiver has it. An extreme that is owed stays so where the value is
/// about to be there again: it is sent when it comes.
void OutputLane::wait_from(Ticks arrival, Ticks until) KNOTWAVE_RT {
  not_before_ = std::max(not_before_, arrival);
  find_change(arrival, until);
  if (left_at_ != not_before_) return;
  leaves_at(curve_.leaves(band_low(), band_high(), not_before_, until));
  if (left_at_ != kNever) not_before_ = left_at_;
}

/// The mean of what the value does until the next message can have come.
OutputLane::Plan OutputLane::mean_plan(Ticks arrival, const Cable& cable) const KNOTWAVE_RT {
  if (auto coarse = coarse_plan(arrival, cable)) return *coarse;
  const Ticks end = arrival + hold(arrival, cable);
  const LaneCurve::Summary range = curve_.summary(arrival, end);
  int step = nearest_step(range.mean);
  // All of it is beyond the edge that is crossed just now.
  if (sent_ >= 0 && range.low > sent_ + 0.4999) step = std::max(step, sent_ + 1);
  if (sent_ >= 0 && range.high < sent_ - 0.4999) step = std::min(step, sent_ - 1);
  return {std::clamp(step, 0, top_), arrival, end};
}

std::optional<OutputLane::Plan> OutputLane::coarse_plan(Ticks arrival,
                                                        const Cable& cable) const KNOTWAVE_RT {
  if (!has_halves() || !cable.is_din()) return {};
  const Ticks one = cable.time_of_bytes(cable.has_running_status() ? 2 : 3);
  const LaneCurve::Summary pair = curve_.summary(arrival, arrival + 2 * one);
  if (pair.high - pair.low <= kFastRange) return {};
  const LaneCurve::Summary range = curve_.summary(arrival, arrival + one);
  const int step = 128 * nearest_step(range.mean / 128);
  if (step < range.low || step > range.high) return {};
  return Plan{step, arrival, arrival + one};
}

void OutputLane::begin(const Plan& plan, Ticks time, Ticks until, const Cable& cable) KNOTWAVE_RT {
  see_until(time, plan.arrival);
  if (sent_ < 0) is_told_from(plan.arrival);
  if (plan.step <= extremes_.low.step) extremes_.low.owed_since = kNever;
  if (plan.step >= extremes_.high.step) extremes_.high.owed_since = kNever;
  sent_before_ = sent_;
  sent_ = plan.step;
  if (has_halves()) {
    high_half_ = sent_ >> 7;
    low_half_ = sent_ & 127;
  }
  arrived_ = plan.arrival;
  is_on_its_way_ = cable.is_din();
  const LaneCurve::Summary held = curve_.summary(plan.arrival, plan.hold_end);
  const bool is_outrun = held.low < band_low() || held.high > band_high();
  not_before_ = std::max(is_outrun ? plan.hold_end : plan.arrival, time + cable.spacing());
  find_change(arrived_, until);
}

void OutputLane::arrives(Ticks time, Ticks until) KNOTWAVE_RT {
  is_on_its_way_ = false;
  if (time <= arrived_) return;
  arrived_ = time;
  not_before_ = std::max(not_before_, time);
  find_change(time, until);
}

/// Counts what was reached up to `now` against what the receiver heard of by then.
void OutputLane::see_until(Ticks now, Ticks held_until) KNOTWAVE_RT {
  const std::int64_t last = now >> kTickBits;
  reach(extremes_, seen_ + 1, last, held_until);
  seen_ = std::max(seen_, last);
}

/// Adds the samples from..to to what was reached; what was sent last is held until `held_until`.
void OutputLane::reach(Extremes& extremes, std::int64_t from_sample, std::int64_t to_sample,
                       Ticks held_until) const KNOTWAVE_RT {
  for (std::int64_t k = std::max(from_sample, addressed_from_); k <= to_sample; ++k) {
    const double v = curve_.sample(k);
    extremes.has_left_rest |= nearest_step(v) != spec_.rest_step;
    // Well within both extremes, as nearly always: kMargin is far more than rounding.
    if (v < extremes.high.step - 0.5 && v > extremes.low.step + 0.5) continue;
    const int high = step_reached_above(v), low = step_reached_below(v);
    const Ticks time = sample_ticks(k);
    note_extreme(extremes, extremes.high, high, 1, time, held_until);
    note_extreme(extremes, extremes.low, low, -1, time, held_until);
  }
}

void OutputLane::note_extreme(Extremes& all, Extreme& extreme, int step, int direction, Ticks time,
                              Ticks held_until) const KNOTWAVE_RT {
  if (time < extreme.from) return;
  const bool is_further = extreme.step < 0 || direction * (step - extreme.step) > 0;
  if (!is_further && step != extreme.step) return;
  if (is_further) extreme = {step, kNever, extreme.from};
  if (is_held(step, direction, time, held_until)) {
    extreme.owed_since = kNever;
  } else if (extreme.owed_since == kNever && is_owed(step, all.has_left_rest, time)) {
    extreme.owed_since = time;
  }
}

/// Always, but for the rest that a value stood at from the beginning.
bool OutputLane::is_owed(int step, bool has_left_rest, Ticks time) const KNOTWAVE_RT {
  return step != spec_.rest_step || (sent_ >= 0 && time >= told_from_ && has_left_rest);
}

/// Such a rest does not stand for an extreme of the curve that comes after it.
void OutputLane::is_told_from(Ticks time) KNOTWAVE_RT {
  told_from_ = time;
  const auto is_rest = [this](const Extreme& extreme) {
    return extreme.step == spec_.rest_step && extreme.owed_since == kNever;
  };
  if (is_rest(extremes_.low)) extremes_.low = {top_ + 1, kNever, time};
  if (is_rest(extremes_.high)) extremes_.high = {-1, kNever, time};
}

/// The receiver hears of `step` or went beyond: it is there at `time`, or a message is on its way.
bool OutputLane::is_held(int step, int direction, Ticks time, Ticks until) const KNOTWAVE_RT {
  if (time >= until) return false;
  const auto reaches = [&](int sent) { return sent >= 0 && direction * (sent - step) >= 0; };
  return reaches(sent_) || ((is_on_its_way_ || time < arrived_) && reaches(sent_before_));
}

/// The extreme that nobody will hear of if it is not sent now: the value has left it by the end.
std::optional<int> OutputLane::owed_step(const Extremes& reached,
                                         Ticks hold_end) const KNOTWAVE_RT {
  const double end = curve_.at(hold_end);
  const bool high =
      reached.high.owed_since != kNever && step_reached_above(end) < reached.high.step;
  const bool low = reached.low.owed_since != kNever && step_reached_below(end) > reached.low.step;
  if (high && low) {
    const bool is_high_first = reached.high.owed_since < reached.low.owed_since;
    return is_high_first ? reached.high.step : reached.low.step;
  }
  if (high) return reached.high.step;
  if (low) return reached.low.step;
  return {};
}

}  // namespace knotwave::engine
