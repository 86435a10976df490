// SPDX-License-Identifier: MIT
#include "knotwave/curves/extrapolate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "double_double.h"

namespace knotwave::curves {
namespace {

constexpr double kFarthest = 1e300;

void hold(const NurbsCurve& curve, bool above, std::span<double> out) noexcept {
  curve.evaluate(above ? curve.u_max() : curve.u_min(), above ? Side::left : Side::right, out);
}

void follow_tangent(const NurbsCurve& curve, double u, bool above, std::span<double> out) noexcept {
  const double end = above ? curve.u_max() : curve.u_min();
  std::array<double, 2 * kMaxDim> from{};
  curve.derivatives(end, 1, above ? Side::left : Side::right, from);
  const auto dim = static_cast<std::size_t>(curve.dim());
  for (std::size_t c = 0; c < dim; ++c) {
    const double slope = from[dim + c];
    const double moved = slope == 0 ? 0 : slope * (u - end);  // not 0 * infinity
    out[c] = std::clamp(from[c] + moved, -kFarthest, kFarthest);
  }
}

/// Where u lies: so many whole periods above the start, and so far into that one.
struct Phase {
  double periods = 0;
  DoubleDouble rest;
};

// For fewer than 2^52 periods: then the product below is right to 2^-53 periods.
Phase phase_of(DoubleDouble from_start, DoubleDouble period, double quotient) noexcept {
  Phase phase;
  phase.periods = std::floor(quotient);
  phase.rest = from_start - period * DoubleDouble(phase.periods);
  // The quotient was rounded: it may lie on the wrong side of a whole number, by one.
  if (phase.rest.hi < 0) {
    phase.periods -= 1;
    phase.rest += period;
  } else if ((phase.rest - period).hi >= 0) {
    phase.periods += 1;
    phase.rest = phase.rest - period;
  }
  return phase;
}

void repeat(const NurbsCurve& curve, double u, bool mirrored, std::span<double> out) noexcept {
  const double low = curve.u_min(), high = curve.u_max();
  const DoubleDouble period = DoubleDouble::difference(high, low);
  const double quotient = (u - low) / period.hi;
  constexpr double kMostPeriods = 0x1p52;
  if (!(std::abs(quotient) < kMostPeriods)) return hold(curve, u > high, out);
  const Phase phase = phase_of(DoubleDouble::difference(u, low), period, quotient);
  const double half = 0.5 * phase.periods;
  if (mirrored && half != std::floor(half)) {
    const double at = (DoubleDouble(high) - phase.rest).hi;
    return curve.evaluate(std::clamp(at, low, high), Side::left, out);
  }
  const double at = (DoubleDouble(low) + phase.rest).hi;
  curve.evaluate(std::clamp(at, low, high), at < high ? Side::right : Side::left, out);
}

}  // namespace

void evaluate_extrapolated(const NurbsCurve& curve, double u, Extrapolation before,
                           Extrapolation after, std::span<double> out) noexcept {
  const bool above = u > curve.u_max();
  if (!above && !(u < curve.u_min())) return curve.evaluate(u, out);
  switch (above ? after : before) {
    case Extrapolation::hold:
      return hold(curve, above, out);
    case Extrapolation::linear:
      return follow_tangent(curve, u, above, out);
    case Extrapolation::periodic:
      return repeat(curve, u, false, out);
    case Extrapolation::mirror:
      return repeat(curve, u, true, out);
  }
}

}  // namespace knotwave::curves
