// SPDX-License-Identifier: MIT
#include "step_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "knotwave/base/document.h"
#include "knotwave/base/elementary.h"
#include "knotwave/base/index.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using base::number_text;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kCaution = 0.98;  // a little short of what is expected to cost 1

double next_double(double u) { return std::nextafter(u, kInfinity); }

/// The longest step from a known to be cheap enough, and the shortest known not to be.
struct Bracket {
  double a;
  double good;
  double bad = kInfinity;
  int tries = 0;

  bool has_good() const { return good > a; }

  /// What to try next if `wanted` is expected to cost 1. Every other time the middle, so that the
  /// bracket narrows whatever the cost does; of a wide one the middle in octaves.
  double better(double wanted) {
    if (!has_good() || !std::isfinite(bad)) return wanted;
    if (bad - a > 16 * (good - a)) return a + std::sqrt((good - a) * (bad - a));
    const bool is_inside = wanted > good && wanted < bad;
    return is_inside && ++tries % 2 == 1 ? wanted : good + (bad - good) / 2;
  }

  /// What is still to be gained is not worth another try.
  bool is_done(double wanted) const {
    return has_good() && (wanted - good < 0.03 * (good - a) || !(wanted < bad));
  }
};

}  // namespace

double StepCost::next_knot(double u) const {
  const auto knots = curve_.knots();
  return std::min(curve_.u_max(), *std::upper_bound(knots.begin(), knots.end() - 1, u));
}

StepCost::Value StepCost::value_at(double u, Side side) const {
  Value value{};
  curve_.evaluate(u, side, value);
  return value;
}

double StepCost::allowed_error() const {
  const auto& policy = std::get<MaxError>(sampling_);
  return policy.full_scale * base::db_to_gain(policy.error_db);
}

template <class Work>
void StepCost::for_each_piece(double a, double b, Work work) const {
  const KnotDomain& domain = homogeneous_.domain;
  for (double left = a; left < b;) {
    const double right = std::min(b, next_knot(left));
    const Knot end = domain.knot(right);
    if (!work(left, right, piece_between(homogeneous_, domain.knot(left), end))) return;
    left = right;
  }
}

double StepCost::growth(double cost) const { return is_error() ? std::sqrt(1 / cost) : 1 / cost; }

double StepCost::of(double a, double b) const {
  if (b == next_double(a)) return is_error() ? rounding_of(a, b) : difference_of(a, b);
  return is_error() ? error_of(a, b) : movement_of(a, b);
}

double StepCost::shortest_step(double a) const {
  return std::max(next_double(a), a + rest_of_span(a) * 0x1p-80);
}

std::string StepCost::why_none(double a) const {
  const double b = shortest_step(a);
  const std::string from = "no step from u = " + number_text(a) + " is short enough: ";
  if (is_error()) {
    return from + "values are rounded by more than the error asked for, " +
           number_text(std::get<MaxError>(sampling_).error_db) + " dB re " +
           number_text(std::get<MaxError>(sampling_).full_scale);
  }
  const double size = std::get<MaxStep>(sampling_).size;
  return from + "up to u = " + number_text(b) + ", the next one there is, it moves by " +
         number_text(of(a, b) * size) + ", but no more than " + number_text(size) +
         " was asked for";
}

// The product of a line and the weight of a piece, in Bernstein form.
BezierPiece StepCost::over_weights(const Place& start, const Place& end, const BezierPiece& piece) {
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

// Against the straight line between the values at a and b. The line is written over the weights
// of the piece, one degree higher: then both have the same denominator, and the bound of what is
// left is a sharp one.
double StepCost::error_of(double a, double b) const {
  const Value first = value_at(a, Side::right), last = value_at(b, Side::left);
  const double allowed = allowed_error();
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

// From one double to the next there is no u to be far from the curve at, but both values are
// rounded.
double StepCost::rounding_of(double a, double b) const {
  const BezierPiece piece =
      piece_between(homogeneous_, homogeneous_.domain.knot(a), homogeneous_.domain.knot(b));
  const auto apart = [&](const Value& value, const HomogeneousPoint& exact) {
    double square = 0;
    for (std::size_t c = 0; c < index_of(curve_.dim()); ++c) {
      const double difference = (exact.x[c] / exact.w - value[c]).hi;
      square += difference * difference;
    }
    return std::sqrt(square);
  };
  return std::max(apart(value_at(a, Side::right), piece.points.front()),
                  apart(value_at(b, Side::left), piece.points.back())) /
         allowed_error();
}

// From the least to the greatest of the values at both ends and the points of all pieces.
double StepCost::movement_of(double a, double b) const {
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

// From one double to the next there is no u to move to and come back from.
double StepCost::difference_of(double a, double b) const {
  const Value first = value_at(a, Side::right), last = value_at(b, Side::left);
  double longest = 0;
  for (std::size_t c = 0; c < index_of(curve_.dim()); ++c) {
    longest = std::max(longest, std::abs(last[c] - first[c]));
  }
  return longest / std::get<MaxStep>(sampling_).size;
}

std::optional<double> StepSearch::next(double a, double end) {
  if (!(length_ > 0)) length_ = cost_.rest_of_span(a);
  const double shortest = std::min(cost_.shortest_step(a), end);
  Bracket bracket{a, a};
  double shrink = 1;
  for (double b = std::clamp(a + length_, shortest, end);;) {
    const double cost = cost_.of(a, b);
    (cost <= 1 ? bracket.good : bracket.bad) = b;
    if (bracket.good == end || (bracket.good == b && cost > 0.9)) break;
    if (bracket.bad == shortest) return std::nullopt;
    double times = std::clamp(kCaution * cost_.growth(std::max(cost, 1e-3)), 0.3, 4.0);
    if (!bracket.has_good()) {
      // Where weights put all that happens into 1e-12 of a span, cost says nothing of length.
      times = std::min(times, shrink);
      shrink *= std::min(shrink, 0.5);
    }
    const double wanted = bracket.better(a + (b - a) * times);
    if (bracket.is_done(wanted)) break;
    b = std::clamp(wanted, shortest, end);
  }
  length_ = bracket.good - a;
  return bracket.good;
}

}  // namespace knotwave::curves
