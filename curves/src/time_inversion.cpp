// SPDX-License-Identifier: MIT
#include "time_inversion.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"

#include "next_double.h"
#include "piece_bounds.h"
#include "piece_fit.h"
#include "piece_proof.h"

namespace knotwave::curves {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

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

/// What an affine piece can be off by: rounding, and its ends, which are times rounded.
double affine_error(const SpanPolynomial& span, double x_a, double x_b,
                    std::span<const double> piece) {
  const double late = std::abs((coordinate_at(span, 0, 0.0) - DoubleDouble(x_a)).hi) +
                      std::abs((coordinate_at(span, 0, 1.0) - DoubleDouble(x_b)).hi);
  double worst = 0;
  for (std::size_t c = 0; c < piece.size(); c += kMaxPieceDegree + 1) {
    const auto row = piece.subspan(c, kMaxPieceDegree + 1);
    double slope = 0;
    for (std::size_t k = 1; k < row.size(); ++k) slope += double(k) * std::abs(row[k]);
    worst = std::max(worst, late / (x_b - x_a) * slope + 0x1p-53 * rounding_units(row));
  }
  return worst * (1 + 0x1p-40);
}

bool stands_still(const SpanPolynomial& span) {
  return !(coordinate_at(span, 0, 0.0).hi < coordinate_at(span, 0, 1.0).hi);
}

/// Where a span's last piece ends: its last time, rounded. Where that is earlier, the double there
/// is played by the next span; if y moves much until the span is over, this one keeps it.
double end_of(const SpanPolynomial& span, bool is_last, const FitLimits& limits,
              FittedPieces& pieces) {
  constexpr double kMuch = 0.05;
  const DoubleDouble end = coordinate_at(span, 0, 1.0);
  if (!(end.lo > 0)) return end.hi;
  const double change = TimeProof(span, limits).change_after(end.hi);
  if (!is_last && change > kMuch * limits.max_error) return next_up(end.hi);
  pieces.max_error = std::max(pieces.max_error, change);
  return end.hi;
}

/// The first time, rounded. The value there is that of the start, even if that is later.
double start_of(const SpanPolynomial& span, const FitLimits& limits, FittedPieces& pieces) {
  const DoubleDouble start = coordinate_at(span, 0, 0.0);
  if (start.lo < 0) {
    pieces.max_error = std::max(pieces.max_error, TimeProof(span, limits).change_before(start.hi));
  }
  return start.hi;
}

bool fit_span(const SpanPolynomial& span, double x_a, double x_b, const FitLimits& limits,
              FittedPieces& pieces) {
  SpanClock clock(span);
  TimeProof prover(span, limits);
  const FitProof proof = [&](const FitPiece& piece, double found, double settled) {
    return prover(piece, found, settled);
  };
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
    if (!fit_pieces(target, x_a, end, limits, proof, pieces)) return false;
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
    if (stands_still(span)) continue;  // y jumps
    const double x_a =
        pieces.breaks.empty() ? start_of(span, limits, pieces) : pieces.breaks.back();
    const double x_b = end_of(span, &span == &spans.back(), limits, pieces);
    if (!(x_b > x_a)) continue;
    if (pieces.breaks.empty()) parts.start_values = values_at(span, 0.0);
    bool enough = true;
    if (is_affine(span)) {
      const std::vector<double> piece = affine_piece(span);
      pieces.add(x_a, x_b, piece);
      pieces.max_error = std::max(pieces.max_error, affine_error(span, x_a, x_b, piece));
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
