// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/analysis.h"
#include "knotwave/curves/calculus.h"
#include "knotwave/curves/extrapolate.h"
#include "knotwave/curves/monotone.h"

#include "fuzz_shapes.h"
#include "nurbs_operations.h"

namespace knotwave::fuzz {
namespace {

using curves::NurbsCurve;
using curves::Side;
using enum ErrorCode;

double place(const NurbsCurve& curve, ByteReader& bytes) {
  return place_in(bytes, curve.knots(), curve.u_min(), curve.u_max());
}

double largest_of(const NurbsCurve& curve, int coordinate) {
  const auto hull = hull_range(curve, coordinate);
  return std::max(std::abs(hull.low), std::abs(hull.high));
}

double at(const NurbsCurve& curve, double u, Side side, int coordinate) {
  double out[curves::kMaxDim];
  curve.evaluate(u, side, out);
  return out[coordinate];
}

Outcome slopes(const NurbsCurve& curve, ByteReader& bytes) {
  const double u = place(curve, bytes);
  double ladder[4 * curves::kMaxDim], value[curves::kMaxDim];
  for (const Side side : {Side::left, Side::right}) {
    curve.derivatives(u, 3, side, ladder);
    curve.evaluate(u, side, value);
    for (int c = 0; c < curve.dim(); ++c) {
      FUZZ_CHECK_AT_MOST(std::abs(ladder[c] - value[c]), ulp_of(curve));
    }
  }
  const auto slope = hodograph(curve);
  if (!slope) {
    check_refusal(slope.error(), {unsupported, coordinate_out_of_range, degree_out_of_range,
                                  weight_out_of_range, too_many_points});
    return std::nullopt;
  }
  check_curve(*slope);
  FUZZ_CHECK(slope->u_min() == curve.u_min() && slope->u_max() == curve.u_max());
  if (curve.is_rational() || curve.is_periodic()) return *slope;
  const Side side = u < curve.u_max() ? Side::right : Side::left;
  curve.derivatives(u, 1, side, ladder);
  slope->evaluate(u, side, value);
  for (int c = 0; c < curve.dim(); ++c) {
    FUZZ_CHECK_AT_MOST(std::abs(ladder[curve.dim() + c] - value[c]), 5 * ulp_of(*slope));
  }
  return *slope;
}

Outcome areas(const NurbsCurve& curve, ByteReader& bytes) {
  const double a = place(curve, bytes), b = place(curve, bytes);
  const int coordinate = bytes.below(curve.dim());
  const auto area = integral(curve, a, b, coordinate), back = integral(curve, b, a, coordinate);
  FUZZ_CHECK(area && back);
  FUZZ_CHECK(*area == -*back);
  const double size = largest_of(curve, coordinate) * std::abs(b - a);
  FUZZ_CHECK_AT_MOST(std::abs(*area), size * (1 + 0x1p-49));
  const auto phase = antiderivative(curve, bytes.number());
  if (!phase) {
    check_refusal(phase.error(), {unsupported, degree_out_of_range, not_finite,
                                  coordinate_out_of_range, too_many_points, knot_multiplicity});
    return std::nullopt;
  }
  check_curve(*phase);
  const double gain =
      at(*phase, b, Side::left, coordinate) - at(*phase, a, Side::right, coordinate);
  FUZZ_CHECK_AT_MOST(std::abs(gain - *area), 10 * ulp_of(*phase));
  return *phase;
}

Outcome lengths(const NurbsCurve& curve, ByteReader& bytes) {
  const double a = place(curve, bytes), b = place(curve, bytes);
  const auto length = arc_length(curve, a, b),
             whole = arc_length(curve, curve.u_min(), curve.u_max());
  FUZZ_CHECK(length && whole);
  FUZZ_CHECK_AT_MOST(0, *length);
  // Both are right to 2^-50 of the control polygon, which is at most that long.
  const double size = std::max(largest_coordinate(curve.points()), curve.u_max() - curve.u_min());
  FUZZ_CHECK_AT_MOST(*length, *whole + 0x1p-49 * 4 * size * curve.point_count());
  const double wanted = bytes.part() * *whole;
  const auto u = parameter_at_length(curve, wanted);
  if (!u) {
    check_refusal(u.error(), {parameter_out_of_range});
    return std::nullopt;
  }
  FUZZ_CHECK(curve.u_min() <= *u && *u <= curve.u_max());
  const double bent = curvature(curve, *u);
  FUZZ_CHECK(!std::isnan(bent));
  return std::nullopt;
}

Outcome ranges(const NurbsCurve& curve, ByteReader& bytes) {
  const int coordinate = bytes.below(curve.dim());
  const double ulp = ulp_of(largest_of(curve, coordinate));
  const auto hull = hull_range(curve, coordinate);
  const auto range = value_range(curve, coordinate);
  FUZZ_CHECK(hull.low <= range.low.value && range.low.value <= range.high.value);
  FUZZ_CHECK(range.high.value <= hull.high);
  const double variation = total_variation(curve, coordinate);
  FUZZ_CHECK_AT_MOST(range.high.value - range.low.value, variation * (1 + 0x1p-50) + 2 * ulp);
  const auto spans = span_hulls(curve, coordinate);
  for (int i = 0; i < 4; ++i) {
    const double u = place(curve, bytes), y = at(curve, u, Side::right, coordinate);
    FUZZ_CHECK_AT_MOST(range.low.value - ulp, y);
    FUZZ_CHECK_AT_MOST(y, range.high.value + ulp);
    const auto span = std::find_if(spans.rbegin(), spans.rend(),
                                   [u](const auto& hulls) { return hulls.u0 <= u; });
    FUZZ_CHECK(span != spans.rend());
    if (u == curve.u_max()) continue;  // of a periodic curve: that of u_min
    FUZZ_CHECK_AT_MOST(span->low - ulp, y);
    FUZZ_CHECK_AT_MOST(y, span->high + ulp);
  }
  if (is_non_decreasing(curve, coordinate)) {
    const double gain = at(curve, curve.u_max(), Side::left, coordinate) -
                        at(curve, curve.u_min(), Side::right, coordinate);
    FUZZ_CHECK_AT_MOST(-gain, 0x1p-43 * largest_of(curve, coordinate));
  }
  return std::nullopt;
}

Outcome roots(const NurbsCurve& curve, ByteReader& bytes) {
  const int coordinate = bytes.below(curve.dim());
  const double u = place(curve, bytes), value = at(curve, u, Side::right, coordinate);
  const auto places = parameters_at(curve, value, coordinate);
  FUZZ_CHECK(std::ranges::is_sorted(places));
  for (const double place : places) FUZZ_CHECK(curve.u_min() <= place && place <= curve.u_max());
  FUZZ_CHECK(parameters_at(curve, NAN, coordinate).empty());
  const auto hull = hull_range(curve, coordinate);
  FUZZ_CHECK(parameters_at(curve, hull.high + 2 + std::abs(hull.high), coordinate).empty());
  for (const auto& found : breaks_of(curve, bytes.below(curve.degree() + 1), coordinate)) {
    FUZZ_CHECK(curve.u_min() <= found.u && found.u < curve.u_max());
    FUZZ_CHECK(found.size != 0);
  }
  const auto greville = greville_abscissae(curve);
  FUZZ_CHECK(std::ranges::is_sorted(greville));
  return std::nullopt;
}

Outcome feet(const NurbsCurve& curve, ByteReader& bytes) {
  std::vector<double> point;
  for (int c = 0; c < curve.dim(); ++c) point.push_back(bytes.number());
  const auto foot = closest_point(curve, point);
  if (!foot) {
    check_refusal(foot.error(), {not_finite, coordinate_out_of_range});
    return std::nullopt;
  }
  FUZZ_CHECK(curve.u_min() <= foot->u && foot->u <= curve.u_max());
  const double size = std::max(largest_coordinate(curve.points()), largest_coordinate(point));
  for (int i = 0; i < 4; ++i) {
    double out[curves::kMaxDim], distance = 0;
    curve.evaluate(place(curve, bytes), out);
    for (int c = 0; c < curve.dim(); ++c) {
      distance = std::hypot(distance, out[c] - point[std::size_t(c)]);
    }
    FUZZ_CHECK_AT_MOST(foot->distance, distance + 8 * ulp_of(size));
  }
  return std::nullopt;
}

Outcome beyond_the_ends(const NurbsCurve& curve, ByteReader& bytes) {
  using enum curves::Extrapolation;
  constexpr curves::Extrapolation kModes[] = {hold, linear, periodic, mirror};
  const auto before = kModes[bytes.below(4)], after = kModes[bytes.below(4)];
  const double u = bytes.number();
  double out[curves::kMaxDim], inside[curves::kMaxDim];
  evaluate_extrapolated(curve, u, before, after, out);
  for (int c = 0; c < curve.dim(); ++c) FUZZ_CHECK_AT_MOST(std::abs(out[c]), 1e300);
  const double within = place(curve, bytes);
  evaluate_extrapolated(curve, within, before, after, out);
  curve.evaluate(within, inside);
  for (int c = 0; c < curve.dim(); ++c) FUZZ_CHECK(out[c] == inside[c]);
  return std::nullopt;
}

Outcome repair(const NurbsCurve& curve, ByteReader& bytes) {
  using enum curves::Regularization;
  constexpr curves::Regularization kModes[] = {none,       contain,      keep_start,
                                               keep_ratio, limit_active, limit_opposite};
  const auto mode = kModes[bytes.below(6)];
  const curves::HandleLengths lengths{bytes.number(), bytes.number()};
  const bool at_start = bytes.one_in(2);
  const auto kept = regularize_handles(lengths, mode, at_start);
  if (mode != none) {
    FUZZ_CHECK(curves::is_monotone_cubic(kept.a, kept.b));
    const auto twice = regularize_handles(kept, mode, at_start);
    FUZZ_CHECK(twice.a == kept.a && twice.b == kept.b);
  }
  const auto repaired = regularize(curve, mode);
  if (!repaired) {
    check_refusal(repaired.error(),
                  {unsupported, dimension_mismatch, not_a_function, too_many_points});
    return std::nullopt;
  }
  check_curve(*repaired);
  FUZZ_CHECK(is_non_decreasing(*repaired, 0));
  return *repaired;
}

constexpr Operation kStudies[] = {slopes, areas, lengths,         ranges,
                                  roots,  feet,  beyond_the_ends, repair};

}  // namespace

std::span<const Operation> studies() { return kStudies; }

}  // namespace knotwave::fuzz
