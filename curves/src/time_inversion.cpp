// SPDX-License-Identifier: MIT
#include "time_inversion.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"

#include "exact_span.h"
#include "flat_times.h"
#include "next_double.h"
#include "piece_bounds.h"
#include "piece_fit.h"
#include "piece_proof.h"

namespace knotwave::curves {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

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
/// is played by the next span, or holds the last value; if y moves much until the span is over,
/// this one keeps it.
double end_of(const NurbsCurve& curve, const TimedPart& part, bool is_last, const FitLimits& limits,
              FittedPieces& pieces) {
  const double much = is_last ? 1 : 0.05;
  const DoubleDouble end = part.span.time_at(part.span.last());
  if (!(end.lo > 0)) return end.hi;
  const double change = TimeProof(part.span, limits).change_after(end.hi);
  if (change > much * limits.max_error) {
    return ExactSpan(curve, part.u0).is_after(end.hi, 1.0) ? next_up(end.hi) : end.hi;
  }
  pieces.note_error(change, end.hi);
  return end.hi;
}

/// The first time, rounded. Where that is later it has the value of the start all the same, or, if
/// y moves much until then, the double before has.
double start_of(const NurbsCurve& curve, const TimedPart& part, const FitLimits& limits,
                FittedPieces& pieces) {
  const DoubleDouble start = part.span.time_at(part.span.first());
  if (!(start.lo < 0)) return start.hi;
  const double change = TimeProof(part.span, limits).change_before(start.hi);
  if (change > limits.max_error) {
    return ExactSpan(curve, part.u0).is_before(start.hi, 0.0) ? next_down(start.hi) : start.hi;
  }
  pieces.note_error(change, start.hi);
  return start.hi;
}

bool fit_part(const TimedPart& part, double x_a, double x_b, const FitLimits& limits,
              FittedPieces& pieces) {
  const SpanPolynomial& span = part.span.of;
  SpanClock clock(part.span);
  TimeProof prover(part.span, limits);
  const FitProof proof = [&](const FitPiece& piece, double found, double settled) {
    return prover(piece, found, settled);
  };
  const FitTarget target = [&](DoubleDouble x, std::span<DoubleDouble> out) {
    const DoubleDouble t = clock.parameter_at(x);
    for (int c = 1; c < span.dim; ++c) out[at(c - 1)] = coordinate_at(span, c, t);
  };
  std::vector<double> ends;
  for (const double x : part.steep) {
    if (x > x_a && x < x_b) ends.push_back(x);
  }
  ends.push_back(x_b);
  for (const double end : ends) {
    if (!fit_pieces(target, x_a, end, limits, proof, pieces)) return false;
    x_a = end;
  }
  return true;
}

/// Pieces of a span over [x_a, x_b].
bool fit_span(const std::vector<TimedPart>& parts, double x_a, double x_b, const FitLimits& limits,
              FittedPieces& pieces) {
  pieces.right.clear();
  for (const TimedPart& part : parts) {
    const double end = std::min(part.until, x_b);
    if (!(end > x_a)) continue;
    if (part.jumps) pieces.right.clear();
    if (!fit_part(part, x_a, end, limits, pieces)) return false;
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

std::vector<TimedPart> whole_part(SpanPolynomial span) {
  const double u0 = span.u0;
  std::vector<TimedPart> parts;
  parts.push_back({u0, {std::move(span)}, {}});
  return parts;
}

/// Adds the pieces of a span, but where no double is in it. False when max_pieces are not enough.
bool invert(const NurbsCurve& curve, SpanPolynomial span, bool is_last, const FitLimits& limits,
            FittedPieces& pieces) {
  const bool is_line = is_affine(span);
  const std::vector<TimedPart> timed =
      is_line ? whole_part(std::move(span)) : timed_parts(curve, std::move(span), limits);
  const double x_a =
      pieces.breaks.empty() ? start_of(curve, timed.front(), limits, pieces) : pieces.breaks.back();
  const double x_b = end_of(curve, timed.back(), is_last, limits, pieces);
  if (!(x_b > x_a)) return true;
  if (!is_line) return fit_span(timed, x_a, x_b, limits, pieces);
  const SpanPolynomial& line = timed.front().span.of;
  const std::vector<double> piece = affine_piece(line);
  pieces.add(x_a, x_b, piece);
  pieces.note_error(affine_error(line, x_a, x_b, piece), x_a);
  return pieces.count() <= limits.max_pieces;
}

/// error_bound_missed, with the place.
Error missed_at(const NurbsCurve& curve, const FittedPieces& pieces,
                const CompileOptions& options) {
  const double x = pieces.worst_at;
  return missed_bound(curve, pieces.max_error, options.max_error,
                      "at x = " + base::number_text(x) +
                          ", u = " + base::number_text(parameter_at_time(curve, x)) +
                          "; that near doubles cannot follow y, ask for a larger error");
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
  std::vector<SpanPolynomial> spans = span_polynomials(HomogeneousCurve(curve));
  parts.end_values = values_at(spans.back(), 1.0);
  for (SpanPolynomial& span : spans) {
    if (stands_still(span)) continue;  // y jumps
    const bool is_first = pieces.breaks.empty(), is_last = &span == &spans.back();
    std::vector<double> start_values = values_at(span, 0.0);
    if (!invert(curve, std::move(span), is_last, limits, pieces)) {
      return too_many_pieces(curve, options);
    }
    if (is_first && !pieces.breaks.empty()) parts.start_values = std::move(start_values);
  }
  if (pieces.count() == 0) {
    return fail(ErrorCode::empty_domain, "curve '" + curve.name() + "': time never moves on");
  }
  if (!(pieces.max_error <= options.max_error)) return missed_at(curve, pieces, options);
  pieces.lay_out(parts);
  return parts;
}

Result<CurveProgram> compile_timed(const NurbsCurve& curve, const CompileOptions& options) {
  auto parts = inverted_parts(curve, options);
  if (!parts) return parts.error();
  return ProgramBuilder::build(std::move(*parts));
}

double parameter_at_time(const NurbsCurve& curve, double x) {
  constexpr double kSure = 0x1p-32;
  std::vector<SpanPolynomial> spans = span_polynomials(HomogeneousCurve(curve));
  for (auto span = spans.rbegin(); span != spans.rend(); ++span) {
    if (!(coordinate_at(*span, 0, 0.0).hi <= x)) continue;
    const double u0 = span->u0;
    const DoubleDouble width = DoubleDouble::difference(span->u1, u0);
    const TimedSpan timed{std::move(*span)};
    SpanClock clock(timed);
    DoubleDouble t = clock.parameter_at(x);
    const SpanClock::Around around = clock.around(x);
    if ((around.high - around.low).hi > kSure && !curve.is_periodic()) {
      t = ExactSpan(curve, u0).place_of(x, around.low, around.high).rounded();
    }
    return (DoubleDouble(u0) + t * width).hi;
  }
  return curve.u_min();
}

}  // namespace knotwave::curves
