// SPDX-License-Identifier: MIT
#include "time_inversion.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "knotwave/base/document.h"

#include "piece_fit.h"

namespace knotwave::curves {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Where a span's time is x: the root of N(t) - x D(t), which never falls on [0, 1]. Newton inside
/// a bracket; at a vertical tangent the root is multiple and halving the bracket takes over.
/// Doubles come near, double-double steps do the rest.
class SpanClock {
 public:
  explicit SpanClock(const SpanPolynomial& span)
      : span_(&span), c_(span.row(0).size()), near_(c_.size()) {}

  /// t in [0, 1]; times outside the span give its ends. Remembers t as the next first guess.
  DoubleDouble parameter_at(DoubleDouble x) {
    const auto time = span_->row(0);
    const auto weight = span_->row(span_->dim);
    DoubleDouble end = 0.0;
    for (std::size_t k = 0; k < c_.size(); ++k) {
      c_[k] = weight[k].hi == 0 ? time[k] : time[k] - x * weight[k];
      near_[k] = c_[k].hi;
      end += c_[k];
    }
    if (c_[0].hi >= 0) return 0.0;
    if (end.hi <= 0) return 1.0;
    const double guess = root(std::span<const double>(near_), t_.hi);
    t_ = root(std::span<const DoubleDouble>(c_), DoubleDouble(guess));
    return t_;
  }

 private:
  static constexpr int kMaxSteps = 200;

  static double leading(double x) { return x; }
  static double leading(DoubleDouble x) { return x.hi; }
  static double value(std::span<const double> c, double t) {
    double sum = c.back();
    for (std::size_t k = c.size() - 1; k-- > 0;) sum = sum * t + c[k];
    return sum;
  }
  static DoubleDouble value(std::span<const DoubleDouble> c, DoubleDouble t) {
    return polynomial_at(c, t);
  }

  /// The slope only steers, so doubles do.
  double slope(double t) const {
    double sum = 0;
    for (std::size_t k = near_.size() - 1; k > 0; --k) sum = sum * t + near_[k] * double(k);
    return sum;
  }

  template <class Real>
  Real root(std::span<const Real> c, Real t) const {
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

  /// Once a step is this small against t, one more makes it negligible.
  template <class Real>
  static constexpr double kClose = std::is_same_v<Real, double> ? 1e-9 : 1e-18;

  const SpanPolynomial* span_;
  std::vector<DoubleDouble> c_;  // N - x D
  std::vector<double> near_;     // rounded
  DoubleDouble t_ = 0.5;
};

/// dx/dt times the weight squared, in doubles: its sign and its small values are what is asked.
double time_slope(const SpanPolynomial& span, double t) {
  const auto n = span.row(0);
  const auto d = span.row(span.dim);
  return (polynomial_slope_at(n, t) * polynomial_at(d, t) -
          polynomial_at(n, t) * polynomial_slope_at(d, t))
      .hi;
}

/// Parameters inside the span where time moves slowest: there y(x) is steep, or vertical. Pieces
/// that end there can shrink towards it from both sides.
std::vector<double> steep_places(const SpanPolynomial& span) {
  constexpr int kSteps = 48;
  constexpr double kSteep = 0.2;  // of the mean speed
  double slope[kSteps + 1];
  double mean = 0;
  for (int i = 0; i <= kSteps; ++i) {
    slope[i] = time_slope(span, static_cast<double>(i) / kSteps);
    mean += slope[i] / (kSteps + 1);
  }
  std::vector<double> places;
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
    places.push_back(0.5 * (low + high));
  }
  return places;
}

bool is_constant(std::span<const DoubleDouble> c, std::size_t from) {
  return std::all_of(c.begin() + static_cast<std::ptrdiff_t>(from), c.end(),
                     [](DoubleDouble x) { return x.hi == 0; });
}

/// Whether t is an affine function of time, so that the span is its own program.
bool is_affine(const SpanPolynomial& span) {
  return span.degree <= kMaxPieceDegree && is_constant(span.row(span.dim), 1) &&
         is_constant(span.row(0), 2);
}

/// Coordinates 1.. of an affine span, padded to kMaxPieceDegree.
std::vector<double> affine_piece(const SpanPolynomial& span) {
  constexpr std::size_t kPowers = kMaxPieceDegree + 1;
  std::vector<double> piece(at(span.dim - 1) * kPowers, 0.0);
  const DoubleDouble weight = span.row(span.dim)[0];
  for (int c = 1; c < span.dim; ++c) {
    for (std::size_t k = 0; k < span.row(c).size(); ++k) {
      piece[at(c - 1) * kPowers + k] = (span.row(c)[k] / weight).hi;
    }
  }
  return piece;
}

bool fit_span(const SpanPolynomial& span, double x_a, double x_b, const FitLimits& limits,
              FittedPieces& pieces) {
  SpanClock clock(span);
  const FitTarget target = [&](DoubleDouble x, std::span<DoubleDouble> out) {
    const DoubleDouble t = clock.parameter_at(x);
    for (int c = 1; c < span.dim; ++c) out[at(c - 1)] = coordinate_at(span, c, t);
  };
  std::vector<double> ends;
  for (const double t : steep_places(span)) {
    const double x = coordinate_at(span, 0, t).hi;
    if (x > x_a && x < x_b && (ends.empty() || x > ends.back())) ends.push_back(x);
  }
  ends.push_back(x_b);
  pieces.right.clear();
  for (const double end : ends) {
    if (!fit_pieces(target, x_a, end, limits, pieces)) return false;
    x_a = end;
  }
  return true;
}

/// The curve up to u, or from u on.
bool is_forward(const NurbsCurve& curve, double u_a, double u_b) {
  const auto part = sub_curve(curve, u_a, u_b);
  return !part || is_non_decreasing(*part);
}

/// Whether time never moves forward between u_a and u_b.
bool is_backward(const NurbsCurve& curve, double u_a, double u_b) {
  const auto part = sub_curve(curve, u_a, u_b);
  if (!part) return true;
  CurveSpec spec = part->spec();
  for (std::size_t i = 0; i < spec.points.size(); i += at(spec.dim)) spec.points[i] *= -1;
  const auto mirrored = NurbsCurve::create(std::move(spec));
  return !mirrored || is_non_decreasing(*mirrored);
}

/// Largest u in [low, high] that passes, by halving; `passes` holds up to some u and not beyond.
template <class Passes>
double last_passing(double low, double high, const Passes& passes) {
  for (int step = 0; step < 60; ++step) {
    const double middle = low + 0.5 * (high - low);
    if (!(middle > low && middle < high)) break;
    (passes(middle) ? low : high) = middle;
  }
  return low;
}

/// Names the first interval of u on which time goes back.
Error goes_back(const NurbsCurve& curve) {
  const double first = last_passing(curve.u_min(), curve.u_max(),
                                    [&](double u) { return is_forward(curve, curve.u_min(), u); });
  const double last =
      last_passing(first, curve.u_max(), [&](double u) { return is_backward(curve, first, u); });
  double from[kMaxDim], to[kMaxDim];
  curve.evaluate(first, from);
  curve.evaluate(last, to);
  return fail(ErrorCode::not_a_function,
              "curve '" + curve.name() + "': time goes back from x = " +
                  base::number_text(from[0]) + " to " + base::number_text(to[0]) +
                  " between u = " + base::number_text(first) + " and " + base::number_text(last));
}

/// Times cannot be left out: a declared jump may move y, not x.
Result<void> check_no_gap(const NurbsCurve& curve) {
  for (const double u : curve.jumps()) {
    double left[kMaxDim], right[kMaxDim];
    curve.evaluate(u, Side::left, left);
    curve.evaluate(u, Side::right, right);
    if (left[0] == right[0]) continue;
    return fail(ErrorCode::not_a_function,
                "curve '" + curve.name() + "': at the jump u = " + base::number_text(u) +
                    " time leaps from x = " + base::number_text(left[0]) + " to " +
                    base::number_text(right[0]));
  }
  return {};
}

/// Value of coordinates 1.. at one end of a span.
std::vector<double> values_at(const SpanPolynomial& span, double t) {
  std::vector<double> values;
  for (int c = 1; c < span.dim; ++c) values.push_back(coordinate_at(span, c, t).hi);
  return values;
}

}  // namespace

Result<ProgramParts> inverted_parts(const NurbsCurve& curve, const CompileOptions& options) {
  if (!is_non_decreasing(curve)) return goes_back(curve);
  if (auto gap = check_no_gap(curve); !gap) return gap.error();
  ProgramParts parts;
  parts.dim = curve.dim() - 1;
  for (int c = 1; c < curve.dim(); ++c) {
    const HullRange hull = hull_range(curve, c);
    parts.low.push_back(hull.low);
    parts.high.push_back(hull.high);
  }
  const FitLimits limits{options.max_error, options.max_pieces, parts.low, parts.high};
  FittedPieces pieces;
  pieces.outputs = parts.dim;
  const std::vector<SpanPolynomial> spans = span_polynomials(HomogeneousCurve(curve));
  for (const SpanPolynomial& span : spans) {
    const double x_a =
        pieces.breaks.empty() ? coordinate_at(span, 0, 0.0).hi : pieces.breaks.back();
    const double x_b = coordinate_at(span, 0, 1.0).hi;
    if (!(x_b > x_a)) continue;  // time stands still: y jumps
    if (pieces.breaks.empty()) parts.start_values = values_at(span, 0.0);
    bool enough = true;
    if (is_affine(span)) {
      pieces.add(x_a, x_b, affine_piece(span));
    } else {
      enough = fit_span(span, x_a, x_b, limits, pieces);
    }
    if (!enough || pieces.count() > options.max_pieces) {
      return too_many_pieces(curve, options);
    }
  }
  if (pieces.count() == 0) {
    return fail(ErrorCode::empty_domain, "curve '" + curve.name() + "': time never moves on");
  }
  parts.end_values = values_at(spans.back(), 1.0);
  if (!(pieces.max_error <= options.max_error)) {
    return missed_bound(curve, pieces.max_error, options.max_error, "this is rounding");
  }
  pieces.lay_out(parts);
  return parts;
}

Result<CurveProgram> compile_timed(const NurbsCurve& curve, const CompileOptions& options) {
  auto parts = inverted_parts(curve, options);
  if (!parts) return parts.error();
  return ProgramBuilder::build(std::move(*parts));
}

double parameter_at_time(const NurbsCurve& curve, double x) {
  const std::vector<SpanPolynomial> spans = span_polynomials(HomogeneousCurve(curve));
  for (auto span = spans.rbegin(); span != spans.rend(); ++span) {
    if (!(coordinate_at(*span, 0, 0.0).hi <= x)) continue;
    const DoubleDouble t = SpanClock(*span).parameter_at(x);
    return (DoubleDouble(span->u0) + t * DoubleDouble::difference(span->u1, span->u0)).hi;
  }
  return curve.u_min();
}

}  // namespace knotwave::curves
