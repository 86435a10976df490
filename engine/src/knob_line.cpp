// SPDX-License-Identifier: MIT
#include "knotwave/engine/knob_line.h"

#include <algorithm>
#include <cstdlib>

namespace knotwave::engine {
namespace {

class LineBuilder {
 public:
  LineBuilder(std::span<const TimedStep> steps, const KnobLineConfig& config)
      : steps_(steps), config_(config) {}

  TimedLine build() && {
    const std::size_t last = steps_.size() - 1;
    if (config_.begin) add(*config_.begin, steps_[0].step);
    add(last == 0 ? steps_[0].time : begin_of_move(1), steps_[0].step);
    for (std::size_t i = 1; i <= last; ++i) {
      arrive(i);
      if (i < last) stay(i);
    }
    if (last > 0 && is_single(last)) add(steps_[last].time + end_way(last), steps_[last].step);
    if (config_.end) add(*config_.end, steps_[last].step);
    return std::move(line_);
  }

 private:
  int change(std::size_t i) const { return steps_[i].step - steps_[i - 1].step; }
  bool is_single(std::size_t i) const { return std::abs(change(i)) == 1; }

  // No earlier than the value before was told, and no more than the ramp.
  double begin_of_move(std::size_t i) const {
    return std::max(steps_[i - 1].last_told, steps_[i].time - config_.ramp);
  }
  // To the last value, within the time that is left.
  double end_way(std::size_t last) const {
    const double left = config_.end ? *config_.end - steps_[last].time : config_.ramp;
    return left > 0 ? std::min(left, config_.ramp) : config_.ramp;
  }

  // What rounding puts at one time is one point.
  void add(double time, double value) {
    if (!line_.times.empty() && !(time > line_.times.back())) return;
    line_.times.push_back(time);
    line_.values.push_back(value);
  }

  void arrive(std::size_t i) {
    if (is_single(i)) return add(steps_[i].time, steps_[i].step - 0.5 * change(i));
    add(begin_of_move(i), steps_[i - 1].step);
    add(steps_[i].time, steps_[i].step);
  }

  // Where it turns back the line would stay half way between two steps.
  void stay(std::size_t i) {
    if (!is_single(i) || !is_single(i + 1) || change(i) == change(i + 1)) return;
    const double gap = steps_[i + 1].time - steps_[i].time;
    const bool is_stop = steps_[i].step == 0 || steps_[i].step == config_.last_step;
    if (!(gap > config_.ramp) && !is_stop) return;
    const double way = std::min(config_.ramp, 0.5 * gap);
    add(steps_[i].time + way, steps_[i].step);
    add(steps_[i + 1].time - way, steps_[i].step);
  }

  std::span<const TimedStep> steps_;
  KnobLineConfig config_;
  TimedLine line_;
};

}  // namespace

Result<TimedLine> knob_line(std::span<const TimedStep> steps, const KnobLineConfig& config) {
  const bool stands = config.begin && config.end && *config.begin < *config.end;
  if (steps.empty() || (steps.size() == 1 && !stands)) {
    return fail(ErrorCode::too_few_points,
                "a knob's way needs 2 values or more, found " + std::to_string(steps.size()));
  }
  return LineBuilder(steps, config).build();
}

}  // namespace knotwave::engine
