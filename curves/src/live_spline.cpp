// SPDX-License-Identifier: MIT
#include "live_spline.h"

#include <algorithm>

#include "knotwave/base/index.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using Kind = ControlRange::Kind;
constexpr int kMostPoints = kMaxPieceDegree + 1;

}  // namespace

LiveSpline::LiveSpline(const NurbsCurve& curve, const std::vector<ControlRange>& controls)
    : degree_(curve.degree()),
      dim_(curve.dim()),
      rational_(curve.is_rational()),
      knots_(curve.knots().begin(), curve.knots().end()),
      points_(curve.points().begin(), curve.points().end()),
      weights_(curve.weights().begin(), curve.weights().end()) {
  // A periodic curve of n points has point i again at i + n, and knot i at p + i + n and p + i - n.
  const int all_points = curve.point_count(), all_knots = static_cast<int>(knots_.size());
  const int period = curve.is_periodic() ? all_points - degree_ : all_knots;
  for (std::size_t k = 0; k < controls.size(); ++k) {
    const ControlRange& control = controls[k];
    const bool is_knot = control.kind == Kind::knot;
    const int last = is_knot ? all_knots : all_points;
    int index = control.point + (is_knot && curve.is_periodic() ? degree_ - period : 0);
    for (; index < last; index += period) {
      if (index >= 0) moved_.push_back({control.kind, index, control.coordinate, k});
    }
    rational_ = rational_ || control.kind == Kind::weight;
  }
}

double LiveSpline::knot(int index, std::span<const double> moves) const KNOTWAVE_RT {
  for (const Moved& moved : moved_) {
    if (moved.kind == Kind::knot && moved.index == index) {
      return knots_[index_of(index)] + moves[moved.control];
    }
  }
  return knots_[index_of(index)];
}

int LiveSpline::span_at(double u, std::span<const double> moves) const KNOTWAVE_RT {
  // Of the spans that are not empty, from the one at rest.
  const auto first = knots_.begin() + degree_, last = knots_.end() - degree_ - 1;
  const bool at_end = u >= *last;
  const auto above =
      at_end ? std::lower_bound(first, last, *last) : std::upper_bound(first + 1, last, u);
  const int span = static_cast<int>(above - knots_.begin()) - 1;
  if (at_end) return span;
  if (span > degree_ && u < knot(span, moves)) return span - 1;
  if (above != last && u >= knot(span + 1, moves)) return span + 1;
  return span;
}

LiveSpline::Jet LiveSpline::at(double u, int coordinate,
                               std::span<const double> moves) const KNOTWAVE_RT {
  const int p = degree_, span = span_at(u, moves), first = span - p;
  // Knots first + 1 .. span + p, points first .. span.
  double t[2 * kMaxPieceDegree], x[kMostPoints], w[kMostPoints];
  for (int i = 0; i < 2 * p; ++i) t[i] = knots_[index_of(first + 1 + i)];
  for (int i = 0; i <= p; ++i) {
    x[i] = points_[index_of((first + i) * dim_ + coordinate)];
    w[i] = weights_[index_of(first + i)];
  }
  for (const Moved& moved : moved_) {
    const int i = moved.index - first;
    if (moved.kind == Kind::knot) {
      if (i >= 1 && i <= 2 * p) t[i - 1] += moves[moved.control];
    } else if (i >= 0 && i <= p) {
      if (moved.kind == Kind::weight) w[i] += moves[moved.control];
      if (moved.kind == Kind::coordinate && moved.coordinate == coordinate)
        x[i] += moves[moved.control];
    }
  }
  for (int i = 0; rational_ && i <= p; ++i) x[i] *= w[i];
  double x_slope = 0, w_slope = 0;
  for (int level = 1; level <= p; ++level) {
    if (level == p) {
      const double steep = p / (t[p] - t[p - 1]);
      x_slope = (x[p] - x[p - 1]) * steep;
      w_slope = (w[p] - w[p - 1]) * steep;
    }
    for (int j = p; j >= level; --j) {
      const double blend = (u - t[j - 1]) / (t[j - 1 + p - level + 1] - t[j - 1]);
      x[j] = (1 - blend) * x[j - 1] + blend * x[j];
      if (rational_) w[j] = (1 - blend) * w[j - 1] + blend * w[j];
    }
  }
  if (!rational_) return {x[p], x_slope};
  const double value = x[p] / w[p];
  return {value, (x_slope - value * w_slope) / w[p]};
}

}  // namespace knotwave::curves
