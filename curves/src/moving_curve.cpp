// SPDX-License-Identifier: MIT
#include "knotwave/curves/moving_curve.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"

#include "homogeneous.h"
#include "moving_kernel.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using base::number_text;

constexpr int kMostHalvings = 50;
/// What a number of a point counts as. Below 2^-800 halvings could reach where doubles fade out.
double settled(double x) KNOTWAVE_RT {
  if (!(std::abs(x) >= 0x1p-800)) return 0;  // NaN too
  return std::clamp(x, -kMaxCoordinate, kMaxCoordinate);
}

/// What point i of the span has in Bézier point j, [(p+1) * (p+1)].
std::vector<double> shares_of(const HomogeneousCurve& curve, int span) {
  const int p = curve.degree;
  HomogeneousCurve part = curve.points_between(span - p, span);
  std::vector<HomogeneousPoint> bezier(index_of(p + 1));
  std::vector<double> shares(index_of((p + 1) * (p + 1)));
  for (int i = 0; i <= p; ++i) {
    for (HomogeneousPoint& point : part.points) point = HomogeneousPoint();
    part.points[index_of(i)].x[0] = 1.0;
    bezier_points(part, p, bezier);
    for (int j = 0; j <= p; ++j) {
      shares[index_of(j * (p + 1) + i)] =
          (bezier[index_of(j)].x[0] * curve.points[index_of(span - p + i)].w).hi;
    }
  }
  return shares;
}

/// Enough for p ratio 2^-N <= 3/4 2^-24, as |dy/dt| <= p ratio R (Floater, CAGD 9 (1992), for
/// weights that differ by a factor of `ratio`).
int halvings_for(int degree, double ratio) {
  int halvings = 26;
  for (double steep = degree * ratio; steep > 3; steep *= 0.5) ++halvings;
  return halvings;
}

}  // namespace

Result<MovingCurve> MovingCurve::create(const NurbsCurve& curve) {
  const std::string what = "curve '" + curve.name() + "': ";
  if (curve.dim() != 2) {
    return fail(ErrorCode::dimension_mismatch,
                what + std::to_string(curve.dim()) + " coordinates, a curve in time has 2");
  }
  if (curve.degree() > kMaxMovingDegree) {
    return fail(ErrorCode::degree_out_of_range, what + "degree " + std::to_string(curve.degree()) +
                                                    ", moving curves have 1.." +
                                                    std::to_string(kMaxMovingDegree));
  }
  if (curve.is_periodic()) {
    return fail(ErrorCode::unsupported,
                what + "periodic, but time does not come back; cut it open");
  }
  MovingCurve moving;
  moving.degree_ = curve.degree();
  moving.point_count_ = curve.point_count();
  const HomogeneousCurve all(curve);
  const int p = curve.degree();
  double ratio = 1;
  for (int span = p; span < curve.point_count(); ++span) {
    if (!(curve.knots()[index_of(span)] < curve.knots()[index_of(span + 1)])) continue;
    moving.first_points_.push_back(span - p);
    const std::vector<double> shares = shares_of(all, span);
    moving.shares_.insert(moving.shares_.end(), shares.begin(), shares.end());
    double least = 0, most = 0;
    for (int j = 0; j <= p; ++j) {
      double weight = 0;
      for (int i = 0; i <= p; ++i) weight += shares[index_of(j * (p + 1) + i)];
      moving.weights_.push_back(weight);
      least = j == 0 ? weight : std::min(least, weight);
      most = std::max(most, weight);
    }
    ratio = std::max(ratio, most / least);
  }
  moving.halvings_ = halvings_for(p, ratio);
  if (moving.halvings_ > kMostHalvings) {
    return fail(ErrorCode::weight_out_of_range,
                what + "weights that differ by a factor of " + number_text(ratio) +
                    " within a span need " + std::to_string(moving.halvings_) +
                    " halvings, the limit is " + std::to_string(kMostHalvings));
  }
  return moving;
}

// The last span that has begun, so that the y after a time that stands still counts.
template <class Number>
int MovingCurve::span_at(double time, const Number& number) const KNOTWAVE_RT {
  const int powers = degree_ + 1;
  int found = 0;
  for (int span = 1; span < static_cast<int>(first_points_.size()); ++span) {
    const double* shares = &shares_[index_of(span * powers * powers)];
    double start = 0;
    for (int i = 0; i < powers; ++i) {
      start += shares[i] * (settled(number(2 * (first_points_[index_of(span)] + i))) - time);
    }
    found = start <= 0 ? span : found;
  }
  return found;
}

// number(i) is number i of the points: x and y by turns.
template <class Number>
void MovingCurve::fill(MovingBlock& block, std::size_t column, double time,
                       const Number& number) const KNOTWAVE_RT {
  const int powers = degree_ + 1;
  time = time == time ? settled(time) : -kMaxCoordinate;
  const int span = span_at(time, number);
  const int first = first_points_[index_of(span)];
  double x[kMaxMovingDegree + 1] = {}, y[kMaxMovingDegree + 1] = {};
  double low = kMaxCoordinate, high = -kMaxCoordinate;
  for (int i = 0; i < powers; ++i) {
    x[i] = settled(number(2 * (first + i))) - time;
    y[i] = settled(number(2 * (first + i) + 1));
    low = std::min(low, y[i]);
    high = std::max(high, y[i]);
  }
  block.low[column] = low;
  block.high[column] = high;
  for (int j = 0; j < powers; ++j) {
    const double* shares = &shares_[index_of((span * powers + j) * powers)];
    double x_sum = 0, y_sum = 0;
    for (int i = 0; i < powers; ++i) {
      x_sum += shares[i] * x[i];
      y_sum += shares[i] * y[i];
    }
    block.x[index_of(j)][column] = x_sum;
    block.y[index_of(j)][column] = y_sum;
    block.w[index_of(j)][column] = weights_[index_of(span * powers + j)];
  }
}

double MovingCurve::at(double time, std::span<const double> points) const KNOTWAVE_RT {
  KNOTWAVE_ASSERT(points.size() == index_of(2 * point_count_));
  MovingBlock block;
  fill(block, 0, time, [&](int i) { return points[index_of(i)]; });
  moving_kernels().solve(block, degree_, halvings_, 1);
  return block.out[0];
}

void MovingCurve::render(std::span<const double> times, std::span<const double* const> points,
                         std::span<double> out) const KNOTWAVE_RT {
  KNOTWAVE_ASSERT(points.size() == index_of(2 * point_count_) && times.size() == out.size());
  const auto solve = moving_kernels().solve;
  MovingBlock block;
  for (std::size_t done = 0; done < out.size(); done += MovingBlock::kColumns) {
    const std::size_t count = std::min(MovingBlock::kColumns, out.size() - done);
    for (std::size_t k = 0; k < count; ++k) {
      fill(block, k, times[done + k], [&](int i) { return points[index_of(i)][done + k]; });
    }
    solve(block, degree_, halvings_, count);
    std::copy_n(block.out.begin(), count, out.begin() + static_cast<std::ptrdiff_t>(done));
  }
}

}  // namespace knotwave::curves
