// SPDX-License-Identifier: MIT
#include "knotwave/dsp/crossfade.h"

namespace knotwave::dsp {
namespace {

// From tools/make_arc_constants.py: v = x (1 + (x^2 - 1) (kBoth + kFifth x^2)) makes the angle of
// the arc linear in x with equal ripple, and is exact at -1, 0 and 1.
constexpr double kBoth = 0x1.a94895e8c2b41p-5;
constexpr double kFifth = 0x1.bb05d9b49d2eep-9;
// The middle weight of the quarter circle, sqrt(1/2).
constexpr double kWeight = 0x1.6a09e667f3bcdp-1;

constexpr double unit(double position) {
  return position > 0 ? (position < 1 ? position : 1.0) : 0.0;
}

constexpr GainPair arc(double position) {
  const double x = 2 * unit(position) - 1;
  const double xx = x * x;
  const double v = x * (1 + (xx - 1) * (kBoth + kFifth * xx));
  const double u = 0.5 * (1 + v);
  const double w = 1 - u;
  const double cross = 2 * kWeight * u * w;
  const double scale = 1 / (u * u + cross + w * w);
  return {static_cast<float>((w * w + cross) * scale), static_cast<float>((u * u + cross) * scale)};
}

}  // namespace

GainPair equal_power(double position) KNOTWAVE_RT { return arc(position); }

GainPair equal_gain(double position) KNOTWAVE_RT {
  const double b = unit(position);
  return {static_cast<float>(1 - b), static_cast<float>(b)};
}

void equal_power(std::span<const double> position, std::span<float> a,
                 std::span<float> b) KNOTWAVE_RT {
  for (std::size_t i = 0; i < position.size(); ++i) {
    const GainPair gains = arc(position[i]);
    a[i] = gains.a;
    b[i] = gains.b;
  }
}

}  // namespace knotwave::dsp
