// SPDX-License-Identifier: MIT
// Where time stands still, or nearly, on a span of a curve. Private to curves. [control]
#pragma once
#include <limits>
#include <vector>

#include "knotwave/curves/nurbs_curve.h"

#include "piece_fit.h"
#include "span_clock.h"

namespace knotwave::curves {

/// What of a span is inverted at once: the times up to `until`.
struct TimedPart {
  double u0 = 0;  ///< where the whole span begins
  TimedSpan span;
  std::vector<double> steep;  ///< times inside where y(x) is steep, or vertical: pieces end there
  double until = std::numeric_limits<double>::infinity();
  bool jumps = false;  ///< y begins anew: time went back a little and has caught up
};

/// The parts of a span in order of time. As a rule one, the span itself. Where time stands still so
/// that double-double cannot tell to `limits.max_error` where it is that time, the span is cut
/// (exact_span.h) and told from there in both directions: then what is 0 there is 0, and how far
/// away a time is, is as sure as the time. Where it goes back there (within rounding, or it would
/// not be a function) it counts as standing still: y jumps.
std::vector<TimedPart> timed_parts(const NurbsCurve& curve, SpanPolynomial span,
                                   const FitLimits& limits);

}  // namespace knotwave::curves
