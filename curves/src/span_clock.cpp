// SPDX-License-Identifier: MIT
#include "span_clock.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace knotwave::curves {
namespace {

constexpr int kMaxSteps = 200;

double leading(double x) { return x; }
double leading(DoubleDouble x) { return x.hi; }
double value(std::span<const double> c, double t) {
  double sum = c.back();
  for (std::size_t k = c.size() - 1; k-- > 0;) sum = sum * t + c[k];
  return sum;
}
DoubleDouble value(std::span<const DoubleDouble> c, DoubleDouble t) { return polynomial_at(c, t); }

/// Once a step is this small against t, one more makes it negligible.
template <class Real>
constexpr double kClose = std::is_same_v<Real, double> ? 1e-9 : 1e-18;

/// N - x D in Bernstein form, and how large the rounding of each coefficient and of what is
/// computed from it may be.
struct Ahead {
  Bernstein time;
  Bernstein noise;

  /// -1 or 1 where time at t is before or after x for certain.
  int sign_at(DoubleDouble t) const {
    const double value = scaled_value(time, t).hi, room = scaled_value(noise, t).hi;
    return value < -room ? -1 : value > room ? 1 : 0;
  }
};

Ahead ahead_of(const TimedSpan& timed, DoubleDouble local) {
  const SpanPolynomial& span = timed.of;
  const auto time = span.bezier_row(0), weight = span.bezier_row(span.dim);
  // A product and a sum a power, each right to 2^-102.
  const double of_value = static_cast<double>(time.size() + 1) * 0x1p-101;
  const double of_terms = span.is_whole ? 0x1p-104 : 0x1p-100;
  Ahead ahead;
  for (std::size_t j = 0; j < time.size(); ++j) {
    const DoubleDouble now = weight[j] * local;
    const DoubleDouble apart = time[j] - now;
    // Products of doubles are exact, and so is what is 0, or a difference of plain doubles.
    const bool is_exact = span.is_whole && (apart.hi == 0 || (time[j].lo == 0 && now.lo == 0));
    const double terms = is_exact ? 0 : std::abs(time[j].hi) + std::abs(now.hi);
    ahead.time.push_back(apart);
    // Cut spans have coefficients of any size, down to where products are 0.
    constexpr double kLeast = 0x1p-900;
    ahead.noise.push_back(of_value * std::abs(apart.hi) + of_terms * terms +
                          (timed.is_exact ? kLeast : 0));
  }
  return ahead;
}

/// The least step below `limit`, but for a factor of 2, that is_certain() holds for; `limit` if
/// none is. The first one tried is 2^-88 of `scale`.
template <class IsCertain>
double certain_step(double scale, double limit, const IsCertain& is_certain) {
  constexpr double kFirst = 0x1p-88, kFaster = 32;
  double step = kFirst * scale;
  if (step < limit && is_certain(step)) return step;
  while (step < limit && !is_certain(step)) step *= kFaster;
  double enough = std::min(step, limit);
  for (double less = step / 2; less > step / kFaster; less /= 2) {
    if (!(less < limit) || !is_certain(less)) break;
    enough = less;
  }
  return enough;
}

}  // namespace

/// The slope only steers, so doubles do.
double SpanClock::slope(double t) const {
  double sum = 0;
  for (std::size_t k = near_.size() - 1; k > 0; --k) sum = sum * t + near_[k] * double(k);
  return sum;
}

template <class Real>
Real SpanClock::root(std::span<const Real> c, Real t) const {
  Real low = 0.0, high = 1.0;
  double before = 1;  // size of the last step
  bool close = false;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Real f = value(c, t);
    if (leading(f) == 0) return t;
    (leading(f) > 0 ? high : low) = t;
    const Real by = leading(f) / slope(leading(t));
    Real next = t - by;
    const double size = std::abs(leading(by));
    const bool inside = leading(next - low) > 0 && leading(high - next) > 0;
    if (close) return inside ? next : t;
    // Out of the bracket, not a number, or not closing in: halve.
    if (!inside || (size > 0.75 * before && step > 2)) {
      next = (low + high) * Real(0.5);
      before = leading(high - low);
      if (!(before > 1e-30 * leading(t))) return t;
    } else {
      before = size;
      close = size <= kClose<Real> * leading(t);
    }
    t = next;
  }
  return t;
}

DoubleDouble SpanClock::parameter_at(DoubleDouble x) { return root_at(span_->local(x)); }

DoubleDouble SpanClock::root_at(DoubleDouble local) {
  const auto time = span_->of.row(0);
  const auto weight = span_->of.row(span_->of.dim);
  DoubleDouble end = 0.0;
  for (std::size_t k = 0; k < c_.size(); ++k) {
    c_[k] = weight[k].hi == 0 ? time[k] : time[k] - local * weight[k];
    near_[k] = c_[k].hi;
    end += c_[k];
  }
  if (c_[0].hi >= 0) return 0.0;
  if (end.hi <= 0) return 1.0;
  const double guess = root(std::span<const double>(near_), t_.hi);
  t_ = root(std::span<const DoubleDouble>(c_), DoubleDouble(guess));
  return t_;
}

SpanClock::Around SpanClock::around(double x) {
  const DoubleDouble local = span_->local(x);
  const Ahead ahead = ahead_of(*span_, local);
  if (span_->is_exact && local.hi == 0 && ahead.time.front().hi == 0) return {0.0, 0.0};
  const DoubleDouble t = ahead.time.front().hi >= 0  ? DoubleDouble(0.0)
                         : ahead.time.back().hi <= 0 ? DoubleDouble(1.0)
                                                     : root_at(local);
  // Where time is x lies between a place before and a place after.
  const DoubleDouble rest = DoubleDouble(1.0) - t;
  const double scale = t.hi > 0 && rest.hi > 0 ? std::min(t.hi, rest.hi) : 1;
  const double back = certain_step(
      scale, t.hi, [&](double step) { return ahead.sign_at(t - DoubleDouble(step)) < 0; });
  const double forth = certain_step(
      scale, rest.hi, [&](double step) { return ahead.sign_at(t + DoubleDouble(step)) > 0; });
  return {back < t.hi ? t - DoubleDouble(back) : DoubleDouble(0.0),
          forth < rest.hi ? t + DoubleDouble(forth) : DoubleDouble(1.0)};
}

}  // namespace knotwave::curves
