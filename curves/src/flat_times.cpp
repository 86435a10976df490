// SPDX-License-Identifier: MIT
#include "flat_times.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exact_span.h"
#include "next_double.h"
#include "piece_proof.h"

namespace knotwave::curves {
namespace {

constexpr int kSteps = 48;

/// A place on a span, and how fast time is there against the mean.
struct Place {
  double t = 0;
  double speed = 1;
};

/// dx/dt times the weight squared, in doubles: its sign and its small values are what is asked.
double time_slope(const SpanPolynomial& span, double t) {
  const auto n = span.row(0);
  const auto d = span.row(span.dim);
  return (polynomial_slope_at(n, t) * polynomial_at(d, t) -
          polynomial_at(n, t) * polynomial_slope_at(d, t))
      .hi;
}

/// Parameters inside the span where time moves slowest, and both ends. Inside, y(x) is steep or
/// vertical there: pieces that end there can shrink towards it from both sides.
std::vector<Place> slow_places(const SpanPolynomial& span) {
  constexpr double kSteep = 0.2;  // of the mean speed
  double slope[kSteps + 1];
  double mean = 0;
  for (int i = 0; i <= kSteps; ++i) {
    slope[i] = time_slope(span, static_cast<double>(i) / kSteps);
    mean += slope[i] / (kSteps + 1);
  }
  std::vector<Place> places{{0, slope[0] / mean}};
  for (int i = 1; i < kSteps; ++i) {
    if (!(slope[i] < kSteep * mean && slope[i] <= slope[i - 1] && slope[i] < slope[i + 1]))
      continue;
    double low = static_cast<double>(i - 1) / kSteps;
    double high = static_cast<double>(i + 1) / kSteps;
    for (int step = 0; step < 60; ++step) {
      const double third = (high - low) / 3;
      if (time_slope(span, low + third) <= time_slope(span, high - third)) {
        high -= third;
      } else {
        low += third;
      }
    }
    const double t = 0.5 * (low + high);
    places.push_back({t, time_slope(span, t) / mean});
  }
  places.push_back({1, slope[kSteps] / mean});
  return places;
}

/// The span's times, and how far double-double may be from one of them.
double noise_of_times(const SpanPolynomial& span) {
  double largest = 0;
  for (std::size_t j = 0; j < span.bezier_row(0).size(); ++j) {
    const DoubleDouble x = span.bezier_row(0)[j] / span.bezier_row(span.dim)[j];
    largest = std::max(largest, std::abs(x.hi));
  }
  return 0x1p-90 * largest;
}

/// A time that has to be cut at: the double nearest to where time stands still, or 0, around which
/// doubles are dense.
struct FlatTime {
  double x = 0;
  BigFloat first, last;  ///< places; two where time goes back in between, within rounding
};

/// Where from t, where time goes back, towards `end` it turns: the first such place.
double turn_of_time(const SpanPolynomial& span, double t, double end) {
  const auto is_backward = [&](double share) {
    return time_slope(span, t + (end - t) * share) < 0;
  };
  double far = 0x1p-60;
  while (far < 1 && is_backward(far)) far *= 2;
  double near = 0.5 * far;
  for (int step = 0; step < 50; ++step) {
    const double middle = 0.5 * (near + far);
    (is_backward(middle) ? near : far) = middle;
  }
  return t + (end - t) * near;
}

/// What double-double knows of a span's times.
class Certainty {
 public:
  Certainty(const TimedSpan& timed, const FitLimits& limits)
      : timed_(timed), limits_(limits), noise_(noise_of_times(timed.of)) {}

  /// Whether it is enough to tell where the time at t is.
  bool is_sure(double t) const {
    if (t == 0 && timed_.of.is_whole) return true;  // power 0 is the first point
    TimeProof proof(timed_, limits_);
    SpanClock clock(timed_);
    const double x = time_at(t), enough = kEnough * limits_.max_error;
    if (proof.change_between(x - room(x), x + room(x)) > enough) return false;
    // Powers of t cancel at the end, most with weights far apart, for doubles further on as well.
    for (const double now : {next_down(x), x, next_up(x)}) {
      const DoubleDouble root = clock.parameter_at(now);
      SpanClock::Around all = clock.around(now);
      if ((root - all.low).hi < 0) all.low = root;
      if ((root - all.high).hi > 0) all.high = root;
      if (proof.change_over(all) > enough) return false;
    }
    const auto [up, down] = backward_at(t);
    return !(up < down) || proof.change_over({up, down}) <= enough;
  }
  FlatTime cut_at(double t, const ExactSpan& exact) const {
    const double x = time_at(t);
    if (t == 0 || t == 1) return {x, t, t};
    const auto [up, down] = backward_at(t);
    if (up < down && exact.is_after(x, up) && exact.is_before(x, down)) {
      return {x, exact.place_of(x, 0.0, up), exact.place_of(x, down, 1.0)};
    }
    const BigFloat place = exact.place_of(x, 0.0, 1.0);
    return {x, place, place};
  }

 private:
  static constexpr double kEnough = 1.0 / 16;

  /// Where around t time goes back.
  std::pair<double, double> backward_at(double t) const {
    if (!(time_slope(timed_.of, t) < 0)) return {t, t};
    return {turn_of_time(timed_.of, t, 0), turn_of_time(timed_.of, t, 1)};
  }
  double time_at(double t) const {
    const auto row = [&](int c) {
      const auto b = timed_.of.bezier_row(c);
      return Bernstein(b.begin(), b.end());
    };
    const double x = quotient_at(row(0), row(timed_.of.dim), t).hi;
    return std::abs(x) <= noise_ ? 0 : x;
  }
  /// Around 0 doubles are dense: there are some in all that double-double may be off by.
  double room(double x) const { return x == 0 ? noise_ : 0; }

  const TimedSpan& timed_;
  const FitLimits& limits_;
  double noise_;
};

/// The parts that end or begin where time stands still at `places`, ends of the span included.
std::vector<TimedPart> cut_parts(const NurbsCurve& curve, const TimedSpan& whole,
                                 const std::vector<double>& places, const FitLimits& limits) {
  const ExactSpan exact(curve, whole.of.u0);
  const Certainty certainty(whole, limits);
  std::vector<FlatTime> flats;
  for (const double t : places) {
    FlatTime flat = certainty.cut_at(t, exact);
    if (flats.empty() || flat.x > flats.back().x) flats.push_back(std::move(flat));
  }
  std::vector<TimedPart> parts;
  for (std::size_t i = 0; i < flats.size(); ++i) {
    const auto& [x, first, last] = flats[i];
    if (first.sign() > 0)
      parts.push_back({whole.of.u0, {exact.before(first, x), x, true, true}, {}, x});
    if ((last - BigFloat(1.0)).sign() >= 0) continue;
    parts.push_back({whole.of.u0, {exact.after(last, x), x, false, true}, {}});
    parts.back().jumps = (last - first).sign() > 0;
    if (i + 1 < flats.size()) parts.back().until = x + 0.5 * (flats[i + 1].x - x);
  }
  return parts;
}

}  // namespace

std::vector<TimedPart> timed_parts(const NurbsCurve& curve, SpanPolynomial span,
                                   const FitLimits& limits) {
  constexpr double kStandstill = 0x1p-30;  // of the mean speed
  const std::vector<Place> places = slow_places(span);
  const double u0 = span.u0;
  std::vector<double> steep;
  for (const Place& place : places) {
    if (place.t == 0 || place.t == 1) continue;
    const double x = coordinate_at(span, 0, place.t).hi;
    if (steep.empty() || x > steep.back()) steep.push_back(x);
  }
  std::vector<TimedPart> parts;
  parts.push_back({u0, {std::move(span)}, {}});
  const TimedSpan& whole = parts.front().span;
  // A span that is cut once is cut at all of them: what it is told from is one.
  std::vector<double> still;
  bool is_sure = true;
  for (const Place& place : places) {
    if (curve.is_periodic() || !(place.speed < kStandstill)) continue;
    still.push_back(place.t);
    is_sure = is_sure && Certainty(whole, limits).is_sure(place.t);
  }
  if (!is_sure) parts = cut_parts(curve, whole, still, limits);
  double after = -std::numeric_limits<double>::infinity();
  for (TimedPart& part : parts) {
    for (const double x : steep) {
      if (x > after && x < part.until) part.steep.push_back(x);
    }
    after = part.until;
  }
  return parts;
}

}  // namespace knotwave::curves
