// SPDX-License-Identifier: MIT
// What one lane does over a block and a little beyond it: its samples, the value between them and
// the time at which it leaves a range. All [audio].
//
// Between two samples runs a parabola through them and through that neighbour which bends it less,
// so a corner on a sample stays a corner; where such a parabola would turn, a straight line. For an
// attack 1 - exp(-4 t / T) the time of a crossing is right within 0.02 us from T = 1 ms on
// (tests/engine/lane_curve_test.cpp). A corner between two samples is known to one sample. A jump,
// which is far from still neighbours, comes at its second sample.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "knotwave/base/time.h"

namespace knotwave::engine {

/// Time in 2^-20 sample: 20 ps at 48 kHz, and 5 years of it.
using Ticks = std::int64_t;
inline constexpr int kTickBits = 20;
inline constexpr Ticks kTicksPerSample = Ticks{1} << kTickBits;
inline constexpr Ticks kNever = std::numeric_limits<Ticks>::max() / 4;

constexpr Ticks sample_ticks(std::int64_t sample) KNOTWAVE_RT { return sample << kTickBits; }
/// Not before `time`.
constexpr Ticks ticks_at_or_after(base::SampleTime time) KNOTWAVE_RT {
  return sample_ticks(time.sample) + ((std::int64_t{time.fraction} + 0xFFF) >> 12);
}
constexpr base::SampleTime time_of(Ticks ticks) KNOTWAVE_RT {
  return {ticks >> kTickBits,
          static_cast<std::uint32_t>((ticks & (kTicksPerSample - 1)) << (32 - kTickBits))};
}

/// f(s) = at_0 + s rise + s (s - 1) / 2 bend between two samples, 0 <= s <= 1, monotone.
struct Arc {
  double at_0, rise, bend;

  double at(double s) const KNOTWAVE_RT { return at_0 + s * rise + (0.5 * s * (s - 1)) * bend; }
  /// Where it meets a level between its ends; 1 where it stands still.
  double place(double level) const KNOTWAVE_RT {
    if (rise == 0) return 1;
    const double a = 0.5 * bend, b = rise - a, c = at_0 - level;
    const double root = std::sqrt(std::max(b * b - 4 * a * c, 0.0));
    const double below = b < 0 ? b - root : b + root;
    return below == 0 ? 0 : std::clamp(-2 * c / below, 0.0, 1.0);
  }
};

/// Far from still neighbours: it comes at its second sample.
inline bool is_jump(double before, double at_0, double at_1, double after) KNOTWAVE_RT {
  const double rise = std::abs(at_1 - at_0);
  return rise > 0.5 && rise > 8 * std::max(std::abs(at_0 - before), std::abs(after - at_1));
}

inline Arc arc_through(double before, double at_0, double at_1, double after) KNOTWAVE_RT {
  if (is_jump(before, at_0, at_1, after)) return {at_0, 0, 0};
  const double rise = at_1 - at_0, rise_before = at_0 - before, rise_after = after - at_1;
  const double left = rise - rise_before, right = rise_after - rise;
  const double bend = std::abs(left) < std::abs(right) ? left : right;
  return {at_0, rise, std::abs(bend) <= 2 * std::abs(rise) ? bend : 0};
}

/// A lane's steps, unrounded, within 0..top; NaN reads 0.
struct LaneCurve {
  std::int64_t first = 0;          ///< of samples[0]
  std::span<const double> values;  ///< empty: it holds before[1]
  double before[2] = {0, 0};       ///< at first - 2, first - 1
  double top = 127;

  double sample(std::int64_t k) const KNOTWAVE_RT {
    const std::int64_t i = k - first;
    double v = before[i < -1 ? 0 : 1];
    if (i >= 0 && !values.empty()) {
      v = values[std::min(static_cast<std::size_t>(i), values.size() - 1)];
    }
    return v >= 0 ? std::min(v, top) : 0;
  }
  Arc arc(std::int64_t k) const KNOTWAVE_RT {
    return arc_through(sample(k - 1), sample(k), sample(k + 1), sample(k + 2));
  }
  double at(Ticks time) const KNOTWAVE_RT {
    const Ticks rest = time & (kTicksPerSample - 1);
    const std::int64_t k = time >> kTickBits;
    return rest == 0 ? sample(k) : arc(k).at(static_cast<double>(rest) * 0x1p-20);
  }
  /// The first time from `from` on at which the value is below `low` or above `high`; kNever if
  /// that is after `until`. Turns between two samples are not seen.
  Ticks leaves(double low, double high, Ticks from, Ticks until) const KNOTWAVE_RT {
    const auto is_out = [&](double v) { return v < low || v > high; };
    if (from > until) return kNever;
    if (is_out(at(from))) return from;
    if (values.empty()) return kNever;
    for (std::int64_t k = from >> kTickBits; sample_ticks(k) <= until; ++k) {
      const double next = sample(k + 1);
      if (!is_out(next)) continue;
      const double s = arc(k).place(next < low ? low : high);
      const Ticks time = sample_ticks(k) + static_cast<Ticks>(std::ceil(s * 0x1p20));
      return std::max(time, from);
    }
    return kNever;
  }
  struct Summary {
    double low, high, mean;
  };
  Summary summary(Ticks from, Ticks until) const KNOTWAVE_RT {
    const double end = at(until);
    double before_value = at(from);
    Summary s{std::min(before_value, end), std::max(before_value, end), 0};
    Ticks before_time = from;
    double area = 0;
    const auto add = [&](Ticks time, double v, double v_here) {
      area += 0.5 * (before_value + v) * static_cast<double>(time - before_time);
      before_time = time;
      before_value = v_here;
    };
    const std::int64_t first_k = (from >> kTickBits) + 1;
    double last = sample(first_k - 1), v = sample(first_k);
    for (std::int64_t k = first_k; sample_ticks(k) < until; ++k) {
      const double next = sample(k + 1);
      s.low = std::min(s.low, v);
      s.high = std::max(s.high, v);
      const bool jumps = std::abs(v - last) > 0.5 && is_jump(sample(k - 2), last, v, next);
      add(sample_ticks(k), jumps ? before_value : v, v);
      last = v;
      v = next;
    }
    add(until, end, end);
    s.mean = until > from ? area / static_cast<double>(until - from) : end;
    return s;
  }
};

}  // namespace knotwave::engine
