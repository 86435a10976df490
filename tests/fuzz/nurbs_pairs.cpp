// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/calculus.h"
#include "knotwave/curves/combine.h"
#include "knotwave/curves/reparametrize.h"

#include "fuzz_shapes.h"
#include "nurbs_operations.h"

namespace knotwave::fuzz {
namespace {

using curves::NurbsCurve;
using curves::Side;
using enum ErrorCode;

constexpr std::initializer_list<ErrorCode> kCompatibleErrors = {
    dimension_mismatch, too_many_points, knot_multiplicity, value_out_of_range};

Outcome second_from(const NurbsCurve& curve, ByteReader& bytes, bool same_domain) {
  const auto second = curve_from(bytes);
  if (!second || !same_domain || bytes.one_in(16)) return second;
  const auto moved = reparametrize(*second, curve.u_min(), curve.u_max());
  return moved ? Outcome(*moved) : std::nullopt;
}

Outcome join_another(const NurbsCurve& curve, ByteReader& bytes) {
  const auto second = second_from(curve, bytes, false);
  if (!second) return std::nullopt;
  const auto whole = join(curve, *second, bytes.one_in(2) ? 0 : std::abs(bytes.number()));
  if (!whole) {
    check_refusal(whole.error(), {dimension_mismatch, unsupported, knot_multiplicity,
                                  weight_out_of_range, too_many_points, value_out_of_range});
    return std::nullopt;
  }
  check_curve(*whole);
  FUZZ_CHECK(whole->u_min() == curve.u_min());
  return *whole;
}

Outcome make_alike(const NurbsCurve& curve, ByteReader& bytes) {
  const auto second = second_from(curve, bytes, true);
  if (!second) return std::nullopt;
  const auto both = make_compatible(curve, *second);
  const double amount = bytes.part();
  const auto start = morph(curve, *second, 0), end = morph(curve, *second, 1);
  const auto mix = morph(curve, *second, amount);
  if (!both) {
    check_refusal(both.error(), kCompatibleErrors);
    FUZZ_CHECK(!start && !end && !mix);
    return std::nullopt;
  }
  check_curve(both->first);
  check_curve(both->second);
  FUZZ_CHECK(std::ranges::equal(both->first.knots(), both->second.knots()));
  FUZZ_CHECK(std::ranges::equal(both->first.jumps(), both->second.jumps()));
  FUZZ_CHECK(both->first.u_min() == curve.u_min() && both->first.u_max() == curve.u_max());
  check_same(curve, both->first, curve.u_min(), curve.u_max(), 5 * ulp_of(curve));
  FUZZ_CHECK(start && *start == both->first);
  FUZZ_CHECK(end && std::ranges::equal(end->points(), both->second.points()));
  FUZZ_CHECK(std::ranges::equal(end->weights(), both->second.weights()));
  FUZZ_CHECK(mix);
  check_curve(*mix);
  return *mix;
}

template <class Operator>
void check_pointwise(const NurbsCurve& first, const NurbsCurve& second, const NurbsCurve& result,
                     double tolerance, ByteReader& bytes, const Operator& operation) {
  double a[curves::kMaxDim], b[curves::kMaxDim], out[curves::kMaxDim];
  for (int i = 0; i < 4; ++i) {
    const double u =
        place_in(bytes, (i % 2 == 0 ? first : second).knots(), first.u_min(), first.u_max());
    for (const Side side : {Side::left, Side::right}) {
      first.evaluate(u, side, a);
      second.evaluate(u, side, b);
      result.evaluate(u, side, out);
      for (int c = 0; c < result.dim(); ++c) {
        const double want = operation(a[first.dim() == 1 ? 0 : c], b[second.dim() == 1 ? 0 : c]);
        FUZZ_CHECK_AT_MOST(std::abs(out[c] - want), tolerance);
      }
    }
  }
}

constexpr std::initializer_list<ErrorCode> kSumErrors = {
    parameter_out_of_range, dimension_mismatch, degree_out_of_range, coordinate_out_of_range,
    weight_out_of_range,    too_many_points,    value_out_of_range,  knot_multiplicity};

Outcome add(const NurbsCurve& curve, ByteReader& bytes) {
  const auto second = second_from(curve, bytes, true);
  if (!second) return std::nullopt;
  const auto total = sum(curve, *second);
  if (!total) {
    check_refusal(total.error(), kSumErrors);
    return std::nullopt;
  }
  check_curve(*total);
  if (curve.dim() != second->dim()) return *total;
  const double ulp = std::max({ulp_of(curve), ulp_of(*second), ulp_of(*total)});
  check_pointwise(curve, *second, *total, 6 * ulp, bytes, [](double a, double b) { return a + b; });
  return *total;
}

Outcome multiply(const NurbsCurve& curve, ByteReader& bytes) {
  const auto second = second_from(curve, bytes, true);
  if (!second) return std::nullopt;
  const auto scaled = product(curve, *second);
  if (!scaled) {
    check_refusal(scaled.error(), kSumErrors);
    return std::nullopt;
  }
  check_curve(*scaled);
  // The factors are rounded too: half an ulp of each times the other.
  const double a = largest_coordinate(curve.points()), b = largest_coordinate(second->points());
  const double tolerance = 5 * ulp_of(*scaled) + a * ulp_of(*second) + b * ulp_of(curve);
  check_pointwise(curve, *second, *scaled, tolerance, bytes,
                  [](double x, double y) { return x * y; });
  return *scaled;
}

Outcome compose_with(const NurbsCurve& curve, ByteReader& bytes) {
  const auto inner = curve_from(bytes);
  if (!inner) return std::nullopt;
  const auto range = hull_range(*inner);
  const auto outer = range.low < range.high ? reparametrize(curve, range.low, range.high)
                                            : Result<NurbsCurve>(curve);
  if (!outer) return std::nullopt;
  const auto whole = compose(*outer, *inner);
  if (!whole) {
    check_refusal(whole.error(), {not_scalar, parameter_out_of_range, degree_out_of_range,
                                  weight_out_of_range, too_many_points, coordinate_out_of_range,
                                  knot_multiplicity, value_out_of_range});
    return std::nullopt;
  }
  check_curve(*whole);
  // Where the outer has a bounded slope, the inner's rounding may move the value by that much.
  const auto slope = hodograph(*outer), pace = hodograph(*inner);
  if (!slope || !pace || outer->is_rational() || inner->is_rational()) return *whole;
  if (outer->is_periodic()) return *whole;
  const double steep = largest_coordinate(slope->points());
  const double ulp_of_u = ulp_of(largest_coordinate(inner->knots()));
  const double tolerance =
      6 * ulp_of(*outer) +
      steep * (4 * ulp_of(*inner) + 2 * largest_coordinate(pace->points()) * ulp_of_u);
  double out[curves::kMaxDim], want[curves::kMaxDim], at = 0;
  for (int i = 0; i < 4; ++i) {
    const double u = place_in(bytes, inner->knots(), inner->u_min(), inner->u_max());
    inner->evaluate(u, {&at, 1});
    outer->evaluate(at, want);
    whole->evaluate(u, out);
    for (int c = 0; c < outer->dim(); ++c) {
      FUZZ_CHECK_AT_MOST(std::abs(out[c] - want[c]), tolerance);
    }
  }
  return *whole;
}

constexpr Operation kPairs[] = {join_another, make_alike, add, multiply, compose_with};

}  // namespace

std::span<const Operation> pairs() { return kPairs; }

}  // namespace knotwave::fuzz
