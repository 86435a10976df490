// SPDX-License-Identifier: MIT
#include "curve_chain.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/index.h"

#include "weights.h"

namespace knotwave::curves {
namespace {

using base::index_of;

double largest_coordinate(std::span<const HomogeneousPoint> points, int dim) {
  double largest = 0;
  for (const HomogeneousPoint& point : points) {
    for (int c = 0; c < dim; ++c) {
      largest = std::max(largest, std::abs(point.x[index_of(c)].hi / point.w.hi));
    }
  }
  return largest;
}

HomogeneousPoint scaled(const HomogeneousPoint& point, DoubleDouble factor) {
  HomogeneousPoint result;
  for (std::size_t c = 0; c < result.x.size(); ++c) result.x[c] = point.x[c] * factor;
  result.w = point.w * factor;
  return result;
}

}  // namespace

CurvePart::CurvePart(const NurbsCurve& clamped)
    : knots(clamped.knots().begin(), clamped.knots().end()),
      points(HomogeneousCurve(clamped).points),
      jumps(clamped.jumps().begin(), clamped.jumps().end()) {}

CurvePart::CurvePart(const BezierSegment& segment)
    : knots(index_of(segment.degree + 1), segment.u0) {
  knots.insert(knots.end(), index_of(segment.degree + 1), segment.u1);
  for (int i = 0; i <= segment.degree; ++i) {
    const auto size = index_of(segment.dim);
    points.emplace_back(std::span(segment.points).subspan(index_of(i) * size, size),
                        segment.weights[index_of(i)]);
  }
}

bool CurveChain::ends_meet(const CurvePart& next, double tolerance) const {
  const auto last = std::span(whole_.points).subspan(last_part_);
  const double rounding =
      0x1p-50 * std::max(largest_coordinate(last, dim_), largest_coordinate(next.points, dim_));
  double left[kMaxDim], right[kMaxDim];
  last.back().project(std::span(left).first(index_of(dim_)));
  next.points.front().project(std::span(right).first(index_of(dim_)));
  for (int c = 0; c < dim_; ++c) {
    if (!(std::abs(left[c] - right[c]) <= std::max(tolerance, rounding))) return false;
  }
  return true;
}

void CurveChain::append(const CurvePart& next, double tolerance) {
  if (whole_.points.empty()) {
    whole_ = next;
    return;
  }
  const double joint = next.knots.front();
  const bool meet = ends_meet(next, tolerance);
  DoubleDouble factor = 1.0;
  if (meet) {
    whole_.knots.pop_back();
    const DoubleDouble ratio = whole_.points.back().w / next.points.front().w;
    if (std::abs(ratio.hi - 1) > 0x1p-50) factor = ratio;  // else only rounding differs
  } else {
    whole_.jumps.push_back(joint);
  }
  last_part_ = whole_.points.size() - (meet ? 1 : 0);
  whole_.knots.insert(whole_.knots.end(), next.knots.begin() + degree_ + 1, next.knots.end());
  for (std::size_t i = meet ? 1 : 0; i < next.points.size(); ++i) {
    whole_.points.push_back(scaled(next.points[i], factor));
  }
  whole_.jumps.insert(whole_.jumps.end(), next.jumps.begin(), next.jumps.end());
}

Result<NurbsCurve> CurveChain::finish(const std::string& name) const {
  CurveSpec spec;
  spec.name = name;
  spec.degree = degree_;
  spec.dim = dim_;
  spec.knots = whole_.knots;
  spec.jumps = whole_.jumps;
  spec.points.resize(whole_.points.size() * index_of(dim_));
  for (std::size_t i = 0; i < whole_.points.size(); ++i) {
    const auto size = index_of(dim_);
    whole_.points[i].project(std::span(spec.points).subspan(i * size, size));
    spec.weights.push_back(whole_.points[i].w.hi);
  }
  if (auto fits = fit_weights("curve '" + name + "'", spec.weights); !fits) return fits.error();
  return NurbsCurve::create(std::move(spec));
}

}  // namespace knotwave::curves
