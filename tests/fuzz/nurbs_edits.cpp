// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/bezier.h"
#include "knotwave/curves/combine.h"
#include "knotwave/curves/reduce.h"
#include "knotwave/curves/reparametrize.h"

#include "fuzz_shapes.h"
#include "nurbs_operations.h"

namespace knotwave::fuzz {
namespace {

using curves::NurbsCurve;
using curves::Side;
using enum ErrorCode;

// 4 ulp of max|P| for the edit, half a one for each of the two values compared.
double edit_tolerance(const NurbsCurve& curve) { return 5 * ulp_of(curve); }

void check_edit(const NurbsCurve& curve, const NurbsCurve& edited) {
  check_curve(edited);
  FUZZ_CHECK(edited.u_min() == curve.u_min() && edited.u_max() == curve.u_max());
  check_same(curve, edited, curve.u_min(), curve.u_max(), edit_tolerance(curve));
}

double place(const NurbsCurve& curve, ByteReader& bytes) {
  return place_in(bytes, curve.knots(), curve.u_min(), curve.u_max());
}

Outcome insert(const NurbsCurve& curve, ByteReader& bytes) {
  const double u = place(curve, bytes);
  const int times = 1 + bytes.below(3);
  const auto finer = insert_knot(curve, u, times);
  if (!finer) {
    check_refusal(finer.error(), {parameter_out_of_range, knot_multiplicity, value_out_of_range});
    return std::nullopt;
  }
  check_edit(curve, *finer);
  FUZZ_CHECK(finer->is_periodic() == curve.is_periodic());
  const auto back = remove_knot(*finer, u, times, 16 * ulp_of(curve));
  if (!back) {
    check_refusal(back.error(), {parameter_out_of_range});
    return *finer;
  }
  check_curve(back->curve);
  FUZZ_CHECK_AT_MOST(back->max_error, 16 * ulp_of(curve));
  // The knots of a seam may be written at its other end.
  const bool at_seam = curve.is_periodic() && (u == curve.u_min() || u == curve.u_max());
  if (back->removed == times && !at_seam) {
    FUZZ_CHECK(std::ranges::equal(back->curve.knots(), curve.knots()));
  }
  check_same(curve, back->curve, curve.u_min(), curve.u_max(), 22 * ulp_of(curve));
  return *finer;
}

Outcome refine_some(const NurbsCurve& curve, ByteReader& bytes) {
  std::vector<double> knots;
  for (int i = bytes.below(5); i >= 0; --i) knots.push_back(place(curve, bytes));
  const auto finer = refine(curve, knots);
  if (!finer) {
    check_refusal(finer.error(), {parameter_out_of_range, knot_multiplicity, value_out_of_range});
    return std::nullopt;
  }
  check_edit(curve, *finer);
  return *finer;
}

// What the bound says and what is seen, at both sides of knots and between.
Outcome reduced(const NurbsCurve& curve, const Result<curves::ReducedCurve>& smaller,
                double tolerance, std::initializer_list<ErrorCode> named) {
  if (!smaller) {
    check_refusal(smaller.error(), named);
    return std::nullopt;
  }
  check_curve(smaller->curve);
  FUZZ_CHECK_AT_MOST(smaller->max_error, tolerance);
  if (smaller->removed == 0) {
    FUZZ_CHECK(smaller->max_error == 0);
    return std::nullopt;
  }
  check_same(curve, smaller->curve, curve.u_min(), curve.u_max(),
             smaller->max_error + ulp_of(curve) + ulp_of(smaller->curve));
  return smaller->curve;
}

double tolerance_from(const NurbsCurve& curve, ByteReader& bytes) {
  return largest_coordinate(curve.points()) * std::ldexp(1.0, -bytes.below(60));
}

Outcome remove_one(const NurbsCurve& curve, ByteReader& bytes) {
  const double u = place(curve, bytes), tolerance = tolerance_from(curve, bytes);
  return reduced(curve, remove_knot(curve, u, 1 + bytes.below(4), tolerance), tolerance,
                 {parameter_out_of_range});
}

Outcome remove_all(const NurbsCurve& curve, ByteReader& bytes) {
  if (curve.point_count() > 24) return std::nullopt;
  const double tolerance = tolerance_from(curve, bytes);
  return reduced(curve, remove_knots(curve, tolerance), tolerance, {});
}

Outcome reduce(const NurbsCurve& curve, ByteReader& bytes) {
  const double tolerance = tolerance_from(curve, bytes);
  return reduced(curve, reduce_degree(curve, tolerance), tolerance,
                 {degree_out_of_range, error_bound_missed});
}

Outcome elevate(const NurbsCurve& curve, ByteReader& bytes) {
  const auto raised = elevate_degree(curve, bytes.below(4));
  if (!raised) {
    check_refusal(raised.error(), {degree_out_of_range, too_many_points, value_out_of_range});
    return std::nullopt;
  }
  check_edit(curve, *raised);
  return *raised;
}

Outcome split_and_join(const NurbsCurve& curve, ByteReader& bytes) {
  const double u = place(curve, bytes);
  const auto parts = split(curve, u);
  if (!parts) {
    check_refusal(parts.error(), {parameter_out_of_range, value_out_of_range});
    return std::nullopt;
  }
  check_curve(parts->left);
  check_curve(parts->right);
  check_same(curve, parts->left, curve.u_min(), u, edit_tolerance(curve));
  check_same(curve, parts->right, u, curve.u_max(), edit_tolerance(curve));
  const auto whole = join(parts->left, parts->right);
  if (!whole) {
    check_refusal(whole.error(), {knot_multiplicity, weight_out_of_range, value_out_of_range});
    return parts->right;
  }
  check_edit(curve, *whole);
  return bytes.one_in(2) ? *whole : parts->left;
}

Outcome part(const NurbsCurve& curve, ByteReader& bytes) {
  const double a = place(curve, bytes), b = place(curve, bytes);
  const auto cut = sub_curve(curve, a, b);
  if (!cut) {
    check_refusal(cut.error(), {parameter_out_of_range, empty_domain, value_out_of_range});
    return std::nullopt;
  }
  check_curve(*cut);
  FUZZ_CHECK(cut->u_min() == a && cut->u_max() == b && cut->is_clamped());
  check_same(curve, *cut, a, b, edit_tolerance(curve));
  return *cut;
}

Outcome backwards(const NurbsCurve& curve, ByteReader&) {
  const auto turned = reverse(curve);
  if (!turned) {
    check_refusal(turned.error(), {knot_multiplicity, value_out_of_range});
    return std::nullopt;
  }
  check_curve(*turned);
  FUZZ_CHECK(turned->u_min() == curve.u_min() && turned->u_max() == curve.u_max());
  const auto again = reverse(*turned);
  if (!again) {
    check_refusal(again.error(), {knot_multiplicity, value_out_of_range});
    return *turned;
  }
  FUZZ_CHECK(std::ranges::equal(again->points(), curve.points()));
  FUZZ_CHECK(std::ranges::equal(again->weights(), curve.weights()));
  const double largest =
      std::max({largest_coordinate(curve.knots()), largest_coordinate(turned->knots())});
  for (std::size_t i = 0; i < curve.knots().size(); ++i) {
    FUZZ_CHECK_AT_MOST(std::abs(again->knots()[i] - curve.knots()[i]), ulp_of(largest));
  }
  return *turned;
}

Outcome move_domain(const NurbsCurve& curve, ByteReader& bytes) {
  const double a = bytes.number(), b = bytes.number();
  const auto moved = reparametrize(curve, a, b);
  if (!moved) {
    check_refusal(moved.error(), {empty_domain, not_finite, value_out_of_range, knot_multiplicity});
    return std::nullopt;
  }
  check_curve(*moved);
  FUZZ_CHECK(moved->u_min() == a && moved->u_max() == b);
  FUZZ_CHECK(std::ranges::equal(moved->points(), curve.points()));
  FUZZ_CHECK(std::ranges::equal(moved->weights(), curve.weights()));
  return *moved;
}

Outcome bend_and_back(const NurbsCurve& curve, ByteReader& bytes) {
  const double b = bytes.one_in(4) ? bytes.number() : std::exp2(16 * bytes.part() - 8);
  const auto bent = bend(curve, b);
  if (!bent) {
    check_refusal(bent.error(),
                  {value_out_of_range, weight_out_of_range, knot_multiplicity, unsupported});
    return std::nullopt;
  }
  check_curve(*bent);
  FUZZ_CHECK(bent->u_min() == curve.u_min() && bent->u_max() == curve.u_max());
  if (curve.is_clamped()) FUZZ_CHECK(std::ranges::equal(bent->points(), curve.points()));
  const auto straight = bend(*bent, 1 / b);
  if (!straight) {
    check_refusal(straight.error(), {value_out_of_range, weight_out_of_range, knot_multiplicity});
    return *bent;
  }
  FUZZ_CHECK(std::ranges::equal(straight->points(), bent->points()));
  const double end = std::max(std::abs(curve.u_min()), std::abs(curve.u_max()));
  for (std::size_t i = 0; curve.is_clamped() && i < curve.knots().size(); ++i) {
    FUZZ_CHECK_AT_MOST(std::abs(straight->knots()[i] - curve.knots()[i]),
                       2 * ulp_of(end) * std::max(b, 1 / b));
  }
  return *bent;
}

Outcome through_bezier(const NurbsCurve& curve, ByteReader& bytes) {
  const auto segments = to_bezier(curve);
  FUZZ_CHECK(!segments.empty());
  FUZZ_CHECK(segments.front().u0 == curve.u_min() && segments.back().u1 == curve.u_max());
  for (const auto& segment : segments) {
    const double u = segment.u0 + bytes.part() * (segment.u1 - segment.u0);
    double a[curves::kMaxDim], b[curves::kMaxDim];
    de_casteljau(segment, u, a);
    curve.evaluate(u, u >= segment.u1 ? Side::left : Side::right, b);
    for (int c = 0; c < curve.dim(); ++c) {
      FUZZ_CHECK_AT_MOST(std::abs(a[c] - b[c]), edit_tolerance(curve));
    }
  }
  const auto back = from_bezier(segments);
  if (!back) {
    check_refusal(back.error(), {weight_out_of_range, too_many_points, value_out_of_range});
    return std::nullopt;
  }
  check_edit(curve, *back);
  return *back;
}

Outcome through_powers(const NurbsCurve& curve, ByteReader& bytes) {
  const auto pieces = to_power_basis(curve);
  FUZZ_CHECK(!pieces.empty());
  const double allowed = (2 + std::pow(3.0, curve.degree())) * ulp_of(curve);
  for (const auto& piece : pieces) {
    const auto segment = from_power_basis(piece);
    if (!segment) {
      check_refusal(segment.error(), {weight_not_positive, weight_out_of_range});
      continue;
    }
    if (curve.is_rational()) continue;  // how far weights cancel is the curve's own affair
    const double u = piece.u0 + bytes.part() * (piece.u1 - piece.u0);
    double a[curves::kMaxDim], b[curves::kMaxDim];
    de_casteljau(*segment, u, a);
    curve.evaluate(u, u >= piece.u1 ? Side::left : Side::right, b);
    for (int c = 0; c < curve.dim(); ++c) FUZZ_CHECK_AT_MOST(std::abs(a[c] - b[c]), allowed);
  }
  return std::nullopt;
}

// The blossom at u, ..., u is the curve; de Boor's algorithm and the basis say the same.
Outcome other_evaluations(const NurbsCurve& curve, ByteReader& bytes) {
  const double u = place(curve, bytes);
  double value[curves::kMaxDim], other[curves::kMaxDim + 1];
  curve.evaluate(u, value);
  de_boor(curve, u, other);
  for (int c = 0; c < curve.dim(); ++c) {
    FUZZ_CHECK_AT_MOST(std::abs(other[c] - value[c]), ulp_of(curve));
  }
  if (curve.is_periodic()) return std::nullopt;
  const int span = find_span(curve.knots(), curve.degree(), u, Side::right);
  const std::vector<double> arguments(std::size_t(curve.degree()), u);
  blossom(curve, span, arguments, other);
  for (int c = 0; c < curve.dim(); ++c) {
    FUZZ_CHECK_AT_MOST(std::abs(other[c] / other[curve.dim()] - value[c]), 3 * ulp_of(curve));
  }
  std::vector<double> basis(std::size_t(curve.degree()) + 1);
  curves::basis_functions(curve.knots(), curve.degree(), span, u, basis);
  double sum = 0;
  for (const double b : basis) {
    FUZZ_CHECK(b >= 0);
    sum += b;
  }
  FUZZ_CHECK_AT_MOST(std::abs(sum - 1), 0x1p-48);
  return std::nullopt;
}

constexpr Operation kEdits[] = {insert,         refine_some,      remove_one,     remove_all,
                                reduce,         elevate,          split_and_join, part,
                                backwards,      move_domain,      bend_and_back,  through_bezier,
                                through_powers, other_evaluations};

}  // namespace

std::span<const Operation> edits() { return kEdits; }

}  // namespace knotwave::fuzz
