// SPDX-License-Identifier: MIT
// The way of a knob from the steps that it told: straight lines for a curve to be fitted to.
// [control]
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/engine/knob_recorder.h"

namespace knotwave::engine {

/// A value of a knob: from `time` on, told last at `last_told`.
struct TimedStep {
  double time = 0, last_told = 0;
  int step = 0;
};

/// Straight lines from (times[i], values[i]) to the next; times increase strictly.
struct TimedLine {
  std::vector<double> times, values;
};

struct KnobLineConfig {
  /// Values that jump by more than a step are reached by a ramp this long, in the unit of the
  /// times; shorter where the value before was told later.
  double ramp = 0.05;
  int last_step = 127;  ///< 0 and this are stops of the knob
  /// The first value stands from `begin` on, the last one until `end`. Without them the line begins
  /// at the first value, but no more than `ramp` before the first move, and ends with the last
  /// move, which takes `ramp` more where it was one step.
  std::optional<double> begin, end;
};

/// The line runs within half a step of the value that was told last, but on ramps, and is within
/// half a step of each value at its time. Where the value goes up or down by one step the knob has
/// just come half way between the two: there the line is at that time. It begins and ends at the
/// first and the last value. Times increase strictly, neighbours differ.
/// Errors: too_few_points (none; one without `begin` and an `end` behind it). O(steps).
Result<TimedLine> knob_line(std::span<const TimedStep> steps, const KnobLineConfig& config);

}  // namespace knotwave::engine
