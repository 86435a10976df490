// SPDX-License-Identifier: MIT
#include "knotwave/curves/tessellate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"
#include "knotwave/curves/map_grid.h"

#include "step_search.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using base::number_text;

Result<void> check(const NurbsCurve& curve, const Sampling& sampling) {
  const auto refuse = [&](const char* name, double value) {
    return fail(ErrorCode::value_out_of_range, "curve '" + curve.name() + "': " + name + " = " +
                                                   number_text(value) +
                                                   " is not positive and finite");
  };
  const auto is_size = [](double x) { return std::isnormal(x) && x > 0; };
  if (const auto* fixed = std::get_if<FixedStep>(&sampling)) {
    if (!is_size(fixed->steps_per_u)) return refuse("steps_per_u", fixed->steps_per_u);
  } else if (const auto* error = std::get_if<MaxError>(&sampling)) {
    if (!is_size(error->full_scale)) return refuse("full_scale", error->full_scale);
    if (!std::isfinite(error->error_db) || std::abs(error->error_db) > 300) {
      return fail(ErrorCode::value_out_of_range,
                  "curve '" + curve.name() + "': error_db = " + number_text(error->error_db) +
                      " is outside -300..300");
    }
  } else if (const auto* step = std::get_if<MaxStep>(&sampling)) {
    if (!is_size(step->size)) return refuse("size", step->size);
  }
  return {};
}

struct InnerKnots {
  std::vector<double> corners;  ///< multiplicity >= degree
  std::vector<double> jumps;    ///< multiplicity > degree
};

InnerKnots inner_knots(const NurbsCurve& curve, double u_a, double u_b) {
  InnerKnots inner;
  const auto knots = curve.knots();
  for (auto knot = knots.begin(); knot != knots.end();) {
    const auto next = std::upper_bound(knot, knots.end(), *knot);
    if (*knot > u_a && *knot < u_b) {
      if (next - knot >= curve.degree()) inner.corners.push_back(*knot);
      if (next - knot > curve.degree()) inner.jumps.push_back(*knot);
    }
    knot = next;
  }
  return inner;
}

class Sampler {
 public:
  Sampler(const NurbsCurve& curve, const Sampling& sampling, int max_values)
      : curve_(curve), sampling_(sampling), search_(curve, sampling), max_values_(max_values) {}

  /// One stretch, cut at `corners`.
  Result<Stretch> sample(double first, double last, const std::vector<double>& corners) {
    Stretch stretch{first};
    std::vector<double> ends;
    for (const double corner : corners) {
      if (corner > first && corner < last) ends.push_back(corner);
    }
    ends.push_back(last);
    const auto* fixed = std::get_if<FixedStep>(&sampling_);
    const auto done = fixed != nullptr ? step_evenly(*fixed, ends, stretch) : search(ends, stretch);
    if (!done) return done.error();
    count_ += static_cast<double>(stretch.size());
    return stretch;
  }

 private:
  Result<void> step_evenly(const FixedStep& policy, const std::vector<double>& ends,
                           Stretch& stretch) const {
    const double first = stretch.front(), last = ends.back();
    const double steps = std::max(1.0, std::ceil((last - first) * policy.steps_per_u));
    const double needed = count_ + steps + 1;
    if (!(needed <= max_values_)) {
      return fail(ErrorCode::too_many_points,
                  "curve '" + curve_.name() + "': " + number_text(needed) +
                      " values are needed to reach u = " + number_text(last) + ", " +
                      std::to_string(max_values_) + " are allowed");
    }
    const MapGrid grid{first, last, static_cast<std::int64_t>(steps)};
    // A node that rounding alone keeps from a corner gives way to it.
    const double near = 1e-6 * (last - first) / steps;
    for (std::int64_t i = 1; i <= grid.n; ++i) {
      const double node = grid.at(i);
      const auto after = std::lower_bound(ends.begin(), ends.end(), node - near);
      if (after == ends.end() || *after > node + near) stretch.push_back(node);
    }
    stretch.insert(stretch.end(), ends.begin(), ends.end());
    std::sort(stretch.begin(), stretch.end());
    return {};
  }

  Result<void> search(const std::vector<double>& ends, Stretch& stretch) {
    for (const double end : ends) {
      while (stretch.back() < end) {
        if (count_ + static_cast<double>(stretch.size()) >= max_values_) {
          return fail(ErrorCode::too_many_points,
                      "curve '" + curve_.name() + "': " + std::to_string(max_values_) +
                          " values are allowed, and they reach u = " + number_text(stretch.back()) +
                          " of " + number_text(ends.back()));
        }
        const auto next = search_.next(stretch.back(), end);
        if (!next) {
          return fail(ErrorCode::error_bound_missed,
                      "curve '" + curve_.name() + "': " + search_.why_none(stretch.back()));
        }
        stretch.push_back(*next);
      }
    }
    return {};
  }

  const NurbsCurve& curve_;
  const Sampling& sampling_;
  StepSearch search_;
  int max_values_;
  double count_ = 0;
};

}  // namespace

Result<std::vector<Stretch>> sample_parameters(const NurbsCurve& curve, const Sampling& sampling,
                                               double u_a, double u_b, int max_values) {
  if (auto ok = check(curve, sampling); !ok) return ok.error();
  for (const double u : {u_a, u_b}) {
    if (u >= curve.u_min() && u <= curve.u_max()) continue;
    return fail(ErrorCode::parameter_out_of_range,
                "curve '" + curve.name() + "': u = " + number_text(u) + " is outside " +
                    number_text(curve.u_min()) + ".." + number_text(curve.u_max()));
  }
  if (!(u_a < u_b)) {
    return fail(ErrorCode::empty_domain, "curve '" + curve.name() +
                                             "': there is nothing from u = " + number_text(u_a) +
                                             " to " + number_text(u_b));
  }
  const InnerKnots inner = inner_knots(curve, u_a, u_b);
  std::vector<double> ends = inner.jumps;
  ends.push_back(u_b);
  Sampler sampler(curve, sampling, max_values);
  std::vector<Stretch> stretches;
  double first = u_a;
  for (const double last : ends) {
    auto stretch = sampler.sample(first, last, inner.corners);
    if (!stretch) return std::move(stretch).error();
    stretches.push_back(std::move(*stretch));
    first = last;
  }
  return stretches;
}

Result<void> tessellate(const NurbsCurve& curve, const Sampling& sampling,
                        const TessellatorCalls& calls, int max_values) {
  const auto stretches =
      sample_parameters(curve, sampling, curve.u_min(), curve.u_max(), max_values);
  if (!stretches) return stretches.error();
  const auto dim = index_of(curve.dim());
  for (const Stretch& stretch : *stretches) {
    if (calls.begin) calls.begin(stretch.front());
    for (const double u : stretch) {
      const Side side = u == stretch.back() ? Side::left : Side::right;
      std::array<double, 2UL * kMaxDim> value{};
      curve.derivatives(u, calls.slope ? 1 : 0, side, value);
      if (calls.value) calls.value(u, std::span(value).first(dim));
      if (calls.slope) calls.slope(u, std::span(value).subspan(dim, dim));
    }
    if (calls.end) calls.end(stretch.back());
  }
  return {};
}

}  // namespace knotwave::curves
