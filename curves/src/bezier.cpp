// SPDX-License-Identifier: MIT
#include "knotwave/curves/bezier.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"

#include "curve_chain.h"
#include "span_polynomial.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using base::number_text;

bool all_finite(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

// What a segment must be by itself; `after` is the one before it, or null.
Result<void> check(const BezierSegment& segment, const BezierSegment* after, std::size_t index) {
  const std::string what = "segment " + std::to_string(index);
  const int p = segment.degree, dim = segment.dim;
  if (p < 1 || p > kMaxDegree || (after != nullptr && p != after->degree)) {
    return fail(ErrorCode::degree_out_of_range,
                what + " has degree " + std::to_string(p) + ", expected " +
                    (after ? std::to_string(after->degree) + " as before"
                           : "1.." + std::to_string(kMaxDegree)));
  }
  const auto count = index_of(p + 1);
  if (dim < 1 || dim > kMaxDim || segment.points.size() != count * index_of(dim) ||
      segment.weights.size() != count || (after != nullptr && dim != after->dim)) {
    return fail(ErrorCode::dimension_mismatch,
                what + " of degree " + std::to_string(p) + " and " + std::to_string(dim) +
                    " coordinates (" + (after ? std::to_string(after->dim) : "1..4") +
                    " expected) has " + std::to_string(segment.points.size()) + " numbers and " +
                    std::to_string(segment.weights.size()) + " weights");
  }
  if (!all_finite(segment.points) || !all_finite(segment.weights) || !std::isfinite(segment.u0) ||
      !std::isfinite(segment.u1)) {
    return fail(ErrorCode::not_finite, what + " has a number that is not finite");
  }
  for (const double w : segment.weights) {
    if (w > 0 && w >= 1e-100 && w <= 1e100) continue;
    return fail(w > 0 ? ErrorCode::weight_out_of_range : ErrorCode::weight_not_positive,
                what + ": weight " + number_text(w) + " is not within 1e-100..1e100");
  }
  if (!(segment.u0 < segment.u1)) {
    return fail(ErrorCode::empty_domain, what + " from " + number_text(segment.u0) + " to " +
                                             number_text(segment.u1) + " has no length");
  }
  if (after != nullptr && segment.u0 != after->u1) {
    return fail(ErrorCode::knots_decrease, what + " begins at " + number_text(segment.u0) +
                                               ", the one before ends at " +
                                               number_text(after->u1));
  }
  return {};
}

}  // namespace

Result<NurbsCurve> from_bezier(std::span<const BezierSegment> segments, double join_tolerance) {
  if (segments.empty()) {
    return fail(ErrorCode::too_few_points, "0 segments, a curve needs at least 1");
  }
  if (!(join_tolerance >= 0)) {
    return fail(ErrorCode::value_out_of_range,
                "a join tolerance of " + number_text(join_tolerance) + " is below 0");
  }
  CurveChain chain(segments.front().degree, segments.front().dim);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    auto good = check(segments[i], i > 0 ? &segments[i - 1] : nullptr, i);
    if (!good) return good.error();
    chain.append(CurvePart(segments[i]), join_tolerance);
  }
  return chain.finish("");
}

std::vector<PowerSegment> to_power_basis(const NurbsCurve& curve) {
  HomogeneousCurve all(curve);
  if (!curve.is_rational()) {
    for (std::size_t i = 0; i < all.points.size(); ++i) {
      const auto size = index_of(curve.dim());
      all.points[i] = HomogeneousPoint(curve.points().subspan(i * size, size), 1);
    }
  }
  std::vector<PowerSegment> pieces;
  for (const SpanPolynomial& span : span_polynomials(all)) {
    PowerSegment piece{span.u0, span.u1, span.degree, span.dim, {}, {}};
    for (int k = 0; k <= span.degree; ++k) {
      for (int c = 0; c < span.dim; ++c) piece.numerator.push_back(span.row(c)[index_of(k)].hi);
      if (span.has_weights) piece.denominator.push_back(span.row(span.dim)[index_of(k)].hi);
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

Result<BezierSegment> from_power_basis(const PowerSegment& piece) {
  const int p = piece.degree, dim = piece.dim;
  if (p < 1 || p > kMaxDegree) {
    return fail(ErrorCode::degree_out_of_range,
                "degree " + std::to_string(p) + " is outside 1.." + std::to_string(kMaxDegree));
  }
  const auto count = index_of(p + 1);
  const bool rational = !piece.denominator.empty();
  if (dim < 1 || dim > kMaxDim || piece.numerator.size() != count * index_of(dim) ||
      (rational && piece.denominator.size() != count)) {
    return fail(ErrorCode::dimension_mismatch,
                std::to_string(piece.numerator.size()) + " numbers in the numerator and " +
                    std::to_string(piece.denominator.size()) +
                    " in the denominator do not make a piece of degree " + std::to_string(p) +
                    " with " + std::to_string(dim) + " coordinates");
  }
  if (!(piece.u0 < piece.u1)) {
    return fail(ErrorCode::empty_domain, "a piece from " + number_text(piece.u0) + " to " +
                                             number_text(piece.u1) + " has no length");
  }
  // Bernstein coefficient j is the sum over k <= j of C(j, k) / C(p, k) times power k.
  BezierSegment segment{piece.u0, piece.u1, p, dim, {}, {}};
  segment.points.resize(count * index_of(dim));
  for (int j = 0; j <= p; ++j) {
    HomogeneousPoint point;
    if (rational) point.w = 0.0;
    DoubleDouble share = 1.0;
    for (int k = 0; k <= j; ++k) {
      for (int c = 0; c < dim; ++c) {
        point.x[index_of(c)] += share * DoubleDouble(piece.numerator[index_of(k * dim + c)]);
      }
      if (rational) point.w += share * DoubleDouble(piece.denominator[index_of(k)]);
      if (k < j) share = share * DoubleDouble(j - k) / DoubleDouble(p - k);
    }
    if (!(point.w.hi > 0)) {
      return fail(ErrorCode::weight_not_positive,
                  "the denominator has the Bézier weight " + number_text(point.w.hi) + " at " +
                      std::to_string(j) + " of " + std::to_string(p));
    }
    segment.weights.push_back(point.w.hi);
    point.project(std::span(segment.points).subspan(index_of(j * dim), index_of(dim)));
  }
  if (!all_finite(segment.points) || !all_finite(segment.weights)) {
    return fail(ErrorCode::not_finite, "a coefficient is not finite, or too large to work with");
  }
  return segment;
}

void blossom(const NurbsCurve& curve, int span, std::span<const double> arguments,
             std::span<double> out) noexcept {
  const int p = curve.degree(), dim = curve.dim();
  const KnotSequence knots{curve.knots(), p, curve.is_periodic()};
  const KnotDomain domain = knots.domain();
  // Distances to every knot by way of the span's left end: an argument may lie on either side.
  const Knot origin = knots[span];
  DoubleDouble place[2 * kMaxDegree];  // of knots span - p + 1 .. span + p
  for (int i = 0; i < 2 * p; ++i) {
    const Knot knot = knots[span - p + 1 + i];
    place[i] = knot <= origin ? -domain.distance(knot, origin) : domain.distance(origin, knot);
  }
  HomogeneousPoint work[kMaxDegree + 1];
  for (int r = 0; r <= p; ++r) {
    const int i = span - p + r;
    work[r] = HomogeneousPoint(curve.points().subspan(index_of(i * dim), index_of(dim)),
                               curve.weights()[index_of(i)]);
  }
  for (int level = 1; level <= p; ++level) {
    const DoubleDouble at =
        DoubleDouble::difference(arguments[index_of(level - 1)], domain.rounded(origin));
    for (int r = 0; r <= p - level; ++r) {
      work[r] = blend(work[r], work[r + 1], at - place[level - 1 + r], place[p + r] - at);
    }
  }
  for (int c = 0; c < dim; ++c) out[index_of(c)] = work[0].x[index_of(c)].hi;
  out[index_of(dim)] = work[0].w.hi;
}

}  // namespace knotwave::curves
