// SPDX-License-Identifier: MIT
#include "spec_checks.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"

namespace knotwave::curves {
namespace {

using base::number_text;
using Fault = std::optional<SpecFault>;
using Part = SpecFault::Part;

using base::index_of;

SpecFault fault(Part part, int index, ErrorCode code, const std::string& what,
                const std::string& says) {
  return {fail(code, what + ": " + says), part, index};
}

std::string count_of(long long n, const char* thing) {
  return std::to_string(n) + " " + thing + (n == 1 ? "" : "s");
}

Fault find_order_fault(const KnotRules& rules) {
  for (int i = 0; i < static_cast<int>(rules.knots.size()); ++i) {
    const double knot = rules.knots[index_of(i)];
    const std::string name = "knot " + std::to_string(i) + " (" + number_text(knot) + ")";
    if (!std::isfinite(knot)) {
      return fault(rules.knots_part, i, ErrorCode::not_finite, rules.what, name + " is not finite");
    }
    if (std::abs(knot) > kMaxKnot) {
      return fault(rules.knots_part, i, ErrorCode::value_out_of_range, rules.what,
                   name + " is outside -" + number_text(kMaxKnot) + ".." + number_text(kMaxKnot));
    }
    if (i > 0 && knot < rules.knots[index_of(i - 1)]) {
      return fault(rules.knots_part, i, ErrorCode::knots_decrease, rules.what,
                   name + " is below knot " + std::to_string(i - 1) + " (" +
                       number_text(rules.knots[index_of(i - 1)]) + ")");
    }
    if (i > 0 && knot > rules.knots[index_of(i - 1)] &&
        knot - rules.knots[index_of(i - 1)] < kMinKnotStep) {
      return fault(rules.knots_part, i, ErrorCode::value_out_of_range, rules.what,
                   name + " is above knot " + std::to_string(i - 1) + " (" +
                       number_text(rules.knots[index_of(i - 1)]) + ") by less than " +
                       number_text(kMinKnotStep));
    }
  }
  return std::nullopt;
}

// A run of equal knots, [first, first + times).
Fault find_run_fault(const KnotRules& rules, int first, int times, double low, double high) {
  const double knot = rules.knots[index_of(first)];
  const bool inside = knot > low && knot < high;
  const bool jump = std::find(rules.jumps.begin(), rules.jumps.end(), knot) != rules.jumps.end();
  const int most = inside && !jump ? rules.degree : rules.degree + 1;
  if (times <= most) return std::nullopt;
  const bool may_be_jump = inside && !jump && times == rules.degree + 1 && !rules.periodic;
  return fault(
      rules.knots_part, first + most, ErrorCode::knot_multiplicity, rules.what,
      "knot " + std::to_string(first) + " (" + number_text(knot) + ") comes " +
          count_of(times, "time") + ", degree " + std::to_string(rules.degree) + " allows " +
          std::to_string(most) + (inside && !jump ? " inside" : "") +
          (may_be_jump ? "; a jump is declared by jumps = [" + number_text(knot) + "]" : ""));
}

Fault find_multiplicity_fault(const KnotRules& rules, double low, double high) {
  const int count = static_cast<int>(rules.knots.size());
  for (int first = 0; first < count;) {
    int end = first + 1;
    while (end < count && rules.knots[index_of(end)] == rules.knots[index_of(first)]) ++end;
    if (auto found = find_run_fault(rules, first, end - first, low, high)) return found;
    first = end;
  }
  return std::nullopt;
}

// The first and last knot of a periodic curve are the same place.
Fault find_seam_fault(const KnotRules& rules) {
  const auto& knots = rules.knots;
  const auto at_start = std::count(knots.begin(), knots.end(), knots.front());
  const auto at_end = std::count(knots.begin(), knots.end(), knots.back());
  if (at_start + at_end - 1 <= rules.degree) return std::nullopt;
  return fault(rules.knots_part, 0, ErrorCode::knot_multiplicity, rules.what,
               "knot 0 (" + number_text(knots.front()) + ") comes " +
                   count_of(at_start + at_end - 1, "time") +
                   " around the seam of the period, degree " + std::to_string(rules.degree) +
                   " allows " + std::to_string(rules.degree));
}

Fault find_jump_fault(const KnotRules& rules, double low, double high) {
  for (int i = 0; i < static_cast<int>(rules.jumps.size()); ++i) {
    const double jump = rules.jumps[index_of(i)];
    const bool known = std::find(rules.knots.begin(), rules.knots.end(), jump) != rules.knots.end();
    if (rules.periodic) {
      return fault(Part::jumps, i, ErrorCode::knot_multiplicity, rules.what,
                   "jump " + std::to_string(i) + " (" + number_text(jump) +
                       ") is in a periodic curve, which has none");
    }
    if (!known || !(jump > low && jump < high)) {
      return fault(Part::jumps, i, ErrorCode::parameter_out_of_range, rules.what,
                   "jump " + std::to_string(i) + " (" + number_text(jump) +
                       ") is not a knot between the ends of the curve");
    }
  }
  return std::nullopt;
}

Fault find_coordinate_fault(const std::string& what, int dim, std::span<const double> points) {
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const double x = points[index_of(i)];
    if (std::isfinite(x) && std::abs(x) <= kMaxCoordinate) continue;
    const std::string where = "point " + std::to_string(i / dim) +
                              (dim > 1 ? ", coordinate " + std::to_string(i % dim) : "") + " (" +
                              number_text(x) + ")";
    return std::isfinite(x)
               ? fault(Part::points, i, ErrorCode::coordinate_out_of_range, what,
                       where + " is outside -" + number_text(kMaxCoordinate) + ".." +
                           number_text(kMaxCoordinate))
               : fault(Part::points, i, ErrorCode::not_finite, what, where + " is not finite");
  }
  return std::nullopt;
}

Fault find_weight_fault(const std::string& what, std::span<const double> weights) {
  for (int i = 0; i < static_cast<int>(weights.size()); ++i) {
    const double w = weights[index_of(i)];
    if (w >= kMinWeight && w <= kMaxWeight) continue;
    const std::string name = "weight " + std::to_string(i) + " (" + number_text(w) + ")";
    if (!std::isfinite(w)) {
      return fault(Part::weights, i, ErrorCode::not_finite, what, name + " is not finite");
    }
    if (w <= 0) {
      return fault(Part::weights, i, ErrorCode::weight_not_positive, what,
                   name + " must be above 0, at least " + number_text(kMinWeight));
    }
    return fault(Part::weights, i, ErrorCode::weight_out_of_range, what,
                 name + " is outside " + number_text(kMinWeight) + ".." + number_text(kMaxWeight));
  }
  return std::nullopt;
}

Fault find_dim_fault(const std::string& what, int dim) {
  if (dim >= 1 && dim <= kMaxDim) return std::nullopt;
  return fault(
      Part::points, -1, ErrorCode::dimension_mismatch, what,
      count_of(dim, "coordinate") + " per point, 1.." + std::to_string(kMaxDim) + " are possible");
}

}  // namespace

Fault find_knot_fault(const KnotRules& rules) {
  const int p = rules.degree, n = rules.count;
  if (p < 1 || p > kMaxDegree) {
    return fault(rules.degree_part, -1, ErrorCode::degree_out_of_range, rules.what,
                 "degree " + std::to_string(p) + " is outside 1.." + std::to_string(kMaxDegree));
  }
  if (n < p + 1) {
    return fault(Part::points, -1, ErrorCode::too_few_points, rules.what,
                 count_of(n, "point") + ", degree " + std::to_string(p) + " needs at least " +
                     std::to_string(p + 1));
  }
  if (n > kMaxPoints) {
    return fault(
        Part::points, -1, ErrorCode::too_many_points, rules.what,
        count_of(n, "point") + ", at most " + std::to_string(kMaxPoints) + " are possible");
  }
  if (rules.knots.empty()) return find_jump_fault(rules, 0, 1);
  const int expected = rules.periodic ? n + 1 : n + p + 1;
  if (static_cast<int>(rules.knots.size()) != expected) {
    return fault(rules.knots_part, -1, ErrorCode::knot_count_mismatch, rules.what,
                 count_of(static_cast<long long>(rules.knots.size()), "knot") + ", expected " +
                     std::to_string(expected) +
                     (rules.periodic ? " (points + 1, periodic)" : " (points + degree + 1)"));
  }
  if (auto found = find_order_fault(rules)) return found;
  const int first = rules.periodic ? 0 : p;
  const int last = rules.periodic ? expected - 1 : n;
  const double low = rules.knots[index_of(first)], high = rules.knots[index_of(last)];
  if (!(low < high)) {
    return fault(rules.knots_part, last, ErrorCode::empty_domain, rules.what,
                 "the curve has no length: knot " + std::to_string(first) + " and knot " +
                     std::to_string(last) + " are both " + number_text(low));
  }
  if (auto found = find_jump_fault(rules, low, high)) return found;
  if (rules.periodic) {
    if (auto found = find_seam_fault(rules)) return found;
  }
  return find_multiplicity_fault(rules, low, high);
}

Fault find_number_fault(const std::string& what, int dim, std::span<const double> points,
                        std::span<const double> weights) {
  const auto count = points.size() / index_of(dim);
  if (!weights.empty() && weights.size() != count) {
    return fault(Part::weights, -1, ErrorCode::weight_count_mismatch, what,
                 count_of(static_cast<long long>(weights.size()), "weight") + " for " +
                     count_of(static_cast<long long>(count), "point"));
  }
  if (auto found = find_coordinate_fault(what, dim, points)) return found;
  return find_weight_fault(what, weights);
}

Fault find_fault(const CurveSpec& spec) {
  const std::string what = "curve '" + spec.name + "'";
  if (auto found = find_dim_fault(what, spec.dim)) return found;
  if (spec.points.size() % index_of(spec.dim) != 0) {
    return fault(Part::points, -1, ErrorCode::dimension_mismatch, what,
                 count_of(static_cast<long long>(spec.points.size()), "number") +
                     " do not make whole points of " + count_of(spec.dim, "coordinate"));
  }
  KnotRules rules;
  rules.what = what;
  rules.degree = spec.degree;
  rules.count =
      static_cast<int>(std::min<std::size_t>(spec.points.size() / index_of(spec.dim), 1u << 30));
  rules.periodic = spec.periodic;
  rules.knots = spec.knots;
  rules.jumps = spec.jumps;
  if (auto found = find_knot_fault(rules)) return found;
  return find_number_fault(what, spec.dim, spec.points, spec.weights);
}

Fault find_fault(const SurfaceSpec& spec) {
  const std::string what = "surface '" + spec.name + "'";
  if (auto found = find_dim_fault(what, spec.dim)) return found;
  KnotRules u{what + " along u", spec.degree_u, spec.count_u, spec.periodic_u, spec.knots_u, {}};
  KnotRules v{what + " along v", spec.degree_v, spec.count_v, false, spec.knots_v, {},
              Part::degree_v,    Part::knots_v};
  if (auto found = find_knot_fault(u)) return found;
  if (auto found = find_knot_fault(v)) return found;
  const long long total = static_cast<long long>(spec.count_u) * spec.count_v;
  if (total > kMaxPoints) {
    return fault(
        Part::points, -1, ErrorCode::too_many_points, what,
        count_of(total, "point") + ", at most " + std::to_string(kMaxPoints) + " are possible");
  }
  const auto expected = static_cast<std::size_t>(total) * index_of(spec.dim);
  if (spec.points.size() != expected) {
    return fault(Part::points, -1, ErrorCode::dimension_mismatch, what,
                 count_of(static_cast<long long>(spec.points.size()), "number") + ", " +
                     std::to_string(spec.count_v) + " rows of " + std::to_string(spec.count_u) +
                     " points with " + count_of(spec.dim, "coordinate") + " are " +
                     std::to_string(expected));
  }
  return find_number_fault(what, spec.dim, spec.points, spec.weights);
}

Result<void> check_parameter(const NurbsCurve& curve, double u) {
  if (u >= curve.u_min() && u <= curve.u_max()) return {};  // not for NaN
  return fail(ErrorCode::parameter_out_of_range,
              "curve '" + curve.name() + "': u = " + number_text(u) + " is outside " +
                  number_text(curve.u_min()) + ".." + number_text(curve.u_max()));
}

}  // namespace knotwave::curves
