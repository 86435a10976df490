// SPDX-License-Identifier: MIT
#include "knotwave/curves/tessellate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "knotwave/base/document.h"
#include "knotwave/base/elementary.h"
#include "knotwave/base/index.h"
#include "knotwave/curves/map_grid.h"

#include "curve_distance.h"

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
  const auto is_size = [](double x) { return std::isfinite(x) && x > 0; };
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

/// What one step of a policy costs: 1 is what is allowed.
class StepCost {
 public:
  StepCost(const NurbsCurve& curve, const Sampling& sampling)
      : curve_(curve), homogeneous_(curve), sampling_(sampling) {}

  /// Over [a, b], inside one stretch. Above kTooMuch it may be more than it says.
  double of(double a, double b) const { return is_error() ? error_of(a, b) : movement_of(a, b); }

  /// How many times as long a step would cost about 1.
  double growth(double cost) const { return is_error() ? std::sqrt(1 / cost) : 1 / cost; }

  /// What is left of the span from a on.
  double rest_of_span(double a) const { return next_knot(a) - a; }

 private:
  static constexpr double kTooMuch = 6;
  using Value = std::array<double, kMaxDim>;

  bool is_error() const { return std::holds_alternative<MaxError>(sampling_); }

  double next_knot(double u) const {
    const auto knots = curve_.knots();
    return std::min(curve_.u_max(), *std::upper_bound(knots.begin(), knots.end() - 1, u));
  }

  Value value_at(double u, Side side) const {
    Value value{};
    curve_.evaluate(u, side, value);
    return value;
  }

  /// work(piece) for each span's part of [a, b] while it returns true.
  template <class Work>
  void for_each_piece(double a, double b, Work work) const {
    const KnotDomain& domain = homogeneous_.domain;
    for (double left = a; left < b;) {
      const double right = std::min(b, next_knot(left));
      const Knot end = domain.knot(right);
      if (!work(left, right, piece_between(homogeneous_, domain.knot(left), end))) return;
      left = right;
    }
  }

  // Against the straight line between the values at a and b. The line is written over the weights
  // of the piece, one degree higher: then both have the same denominator, and the bound of what is
  // left is a sharp one.
  double error_of(double a, double b) const {
    const Value first = value_at(a, Side::right), last = value_at(b, Side::left);
    const auto& policy = std::get<MaxError>(sampling_);
    const double allowed = policy.full_scale * base::db_to_gain(policy.error_db);
    double cost = 0;
    for_each_piece(a, b, [&](double left, double right, BezierPiece piece) {
      const auto line_at = [&](double u) {
        std::array<DoubleDouble, kMaxDim> at;
        const DoubleDouble from_a = DoubleDouble::difference(u, a);
        const DoubleDouble to_b = DoubleDouble::difference(b, u);
        for (std::size_t c = 0; c < at.size(); ++c) {
          at[c] = (to_b * first[c] + from_a * last[c]) / (from_a + to_b);
        }
        return at;
      };
      const BezierPiece line = over_weights(line_at(left), line_at(right), piece);
      raise_degree(piece.points);
      const double error = distance_bound(piece, line, curve_.dim(), kTooMuch * allowed);
      cost = std::max(cost, error / allowed);
      return cost <= kTooMuch;
    });
    return cost;
  }

  using Place = std::array<DoubleDouble, kMaxDim>;

  // The product of a line and the weight of a piece, in Bernstein form.
  static BezierPiece over_weights(const Place& start, const Place& end, const BezierPiece& piece) {
    BezierPiece line = piece;
    raise_degree(line.points);
    const std::size_t degree = piece.points.size();
    for (std::size_t j = 0; j <= degree; ++j) {
      const DoubleDouble of_start =
          j < degree ? piece.points[j].w * static_cast<double>(degree - j) : DoubleDouble(0.0);
      const DoubleDouble of_end =
          j > 0 ? piece.points[j - 1].w * static_cast<double>(j) : DoubleDouble(0.0);
      for (std::size_t c = 0; c < start.size(); ++c) {
        line.points[j].x[c] =
            (of_start * start[c] + of_end * end[c]) / DoubleDouble(static_cast<double>(degree));
      }
    }
    return line;
  }

  // From the least to the greatest of the values at both ends and the points of all pieces.
  double movement_of(double a, double b) const {
    const auto dim = index_of(curve_.dim());
    Value low = value_at(a, Side::right), high = low;
    double longest = 0;
    const auto include = [&](std::size_t c, double x) {
      low[c] = std::min(low[c], x);
      high[c] = std::max(high[c], x);
      longest = std::max(longest, high[c] - low[c]);
    };
    const Value last = value_at(b, Side::left);
    for (std::size_t c = 0; c < dim; ++c) include(c, last[c]);
    const double allowed = std::get<MaxStep>(sampling_).size;
    for_each_piece(a, b, [&](double, double, const BezierPiece& piece) {
      for (const HomogeneousPoint& point : piece.points) {
        for (std::size_t c = 0; c < dim; ++c) include(c, (point.x[c] / point.w).hi);
      }
      return longest <= kTooMuch * allowed;
    });
    return longest / allowed;
  }

  const NurbsCurve& curve_;
  HomogeneousCurve homogeneous_;
  const Sampling& sampling_;
};

/// Steps as long as their cost allows.
class StepSearch {
 public:
  StepSearch(const NurbsCurve& curve, const Sampling& sampling) : cost_(curve, sampling) {}

  /// The end of the step that begins at a, at most `end`; none if even the shortest costs too much.
  std::optional<double> next(double a, double end) {
    if (!(length_ > 0)) length_ = cost_.rest_of_span(a);
    // Weights may put all that happens into 1e-12 of a span; below an ulp of u there is no step.
    const double shortest = std::max(std::abs(a) * 0x1p-52, cost_.rest_of_span(a) * 0x1p-80);
    double good = a, bad = std::numeric_limits<double>::infinity();
    double b = std::min(a + length_, end);
    for (int tries = 0; tries < kMostTries && b > a; ++tries) {
      const double cost = cost_.of(a, b);
      (cost <= 1 ? good : bad) = b;
      if (good == end || (good == b && cost > 0.9)) break;
      const double times = kCaution * cost_.growth(std::max(cost, 1e-3));
      double wanted = a + (b - a) * std::clamp(times, 0.3, 4.0);
      if (!(wanted > good && wanted < bad)) wanted = good + (std::min(bad, end) - good) / 2;
      if (good > a && wanted - good < 0.03 * (good - a)) break;
      if (wanted - a < shortest) break;
      b = std::min(wanted, end);
    }
    if (!(good > a)) return std::nullopt;
    length_ = good - a;
    return good;
  }

 private:
  static constexpr int kMostTries = 80;
  static constexpr double kCaution = 0.98;  // a little short of what is expected to cost 1

  StepCost cost_;
  double length_ = 0;  ///< of the last step
};

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
          return fail(
              ErrorCode::error_bound_missed,
              "curve '" + curve_.name() + "': no step from u = " + number_text(stretch.back()) +
                  " is short enough: the policy asks for less than u and values are rounded by");
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
      std::array<double, 2 * kMaxDim> value{};
      curve.derivatives(u, calls.slope ? 1 : 0, side, value);
      if (calls.value) calls.value(u, std::span(value).first(dim));
      if (calls.slope) calls.slope(u, std::span(value).subspan(dim, dim));
    }
    if (calls.end) calls.end(stretch.back());
  }
  return {};
}

}  // namespace knotwave::curves
