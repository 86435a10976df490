// SPDX-License-Identifier: MIT
#include "homogeneous.h"

#include <algorithm>

#include "knotwave/base/index.h"

namespace knotwave::curves {
namespace {
using base::index_of;
}  // namespace

HomogeneousPoint::HomogeneousPoint(std::span<const double> point, double weight) noexcept
    : w(weight) {
  for (std::size_t c = 0; c < point.size(); ++c) x[c] = DoubleDouble::product(point[c], weight);
}

void HomogeneousPoint::project(std::span<double> out) const noexcept {
  for (std::size_t c = 0; c < out.size(); ++c) out[c] = (x[c] / w).hi;
}

HomogeneousPoint blend(const HomogeneousPoint& a, const HomogeneousPoint& b, DoubleDouble from_left,
                       DoubleDouble to_right) noexcept {
  if (from_left.hi == 0) return a;
  if (to_right.hi == 0) return b;
  // Both parts by division of distances: a small one is as exact as a large one.
  const DoubleDouble width = from_left + to_right;
  const DoubleDouble of_a = to_right / width;
  const DoubleDouble of_b = from_left / width;
  HomogeneousPoint mix;
  for (std::size_t c = 0; c < mix.x.size(); ++c) mix.x[c] = of_a * a.x[c] + of_b * b.x[c];
  mix.w = of_a * a.w + of_b * b.w;
  return mix;
}

HomogeneousCurve::HomogeneousCurve(const NurbsCurve& curve)
    : degree(curve.degree()), dim(curve.dim()) {
  const KnotSequence sequence{curve.knots(), degree, curve.is_periodic()};
  domain = sequence.domain();
  knots = sequence.all();
  const auto size = index_of(dim);
  for (std::size_t i = 0; i < curve.weights().size(); ++i) {
    points.emplace_back(curve.points().subspan(i * size, size), curve.weights()[i]);
  }
}

HomogeneousCurve HomogeneousCurve::points_between(int first, int last) const {
  HomogeneousCurve part;
  part.degree = degree;
  part.dim = dim;
  part.domain = domain;
  part.knots.assign(knots.begin() + first, knots.begin() + last + degree + 2);
  part.points.assign(points.begin() + first, points.begin() + last + 1);
  return part;
}

int HomogeneousCurve::multiplicity(Knot u) const {
  return static_cast<int>(std::count(knots.begin(), knots.end(), u));
}

void HomogeneousCurve::insert(Knot u) {
  const int p = degree;
  const int span = span_at(u, Side::right);
  std::array<HomogeneousPoint, kMaxDegree> blended;
  for (int r = 0; r < p; ++r) {
    const int i = span - p + 1 + r;
    blended[index_of(r)] =
        blend(points[index_of(i - 1)], points[index_of(i)], domain.distance(knots[index_of(i)], u),
              domain.distance(u, knots[index_of(i + p)]));
  }
  points.insert(points.begin() + span, HomogeneousPoint());
  std::copy_n(blended.begin(), p, points.begin() + (span - p + 1));
  knots.insert(std::upper_bound(knots.begin(), knots.end(), u), u);
}

void HomogeneousCurve::insert_and_repeat(Knot u) {
  const int span = span_at(u, Side::right);
  insert(u);
  if (domain.periodic) repeat_period(std::min(span - degree + 1, degree));
}

void HomogeneousCurve::repeat_period(int first_true) {
  const int p = degree, n = static_cast<int>(points.size()) - p;
  for (int i = 0; i < n + p; ++i) {
    const int image = i < first_true ? i + n : i >= first_true + n ? i - n : i;
    points[index_of(i)] = points[index_of(image)];
  }
  for (int i = 0; i < p; ++i) {
    Knot before = knots[index_of(i + n)];
    --before.period;
    knots[index_of(i)] = before;
  }
  for (int i = p + n + 1; i < n + 2 * p + 1; ++i) {
    Knot after = knots[index_of(i - n)];
    ++after.period;
    knots[index_of(i)] = after;
  }
}

HomogeneousCurve HomogeneousCurve::clamped_part(double low, double high) const {
  const int p = degree;
  HomogeneousCurve all = *this;
  const Knot from = domain.knot(low), to = domain.knot(high);
  for (const Knot& u : {from, to}) {
    for (int have = all.multiplicity(u); have < p; ++have) all.insert(u);
  }
  // Spans p..: the first one right of `low` and the last one left of `high` hold the end points.
  const int first = all.span_at(from, Side::right), last = all.span_at(to, Side::left);
  HomogeneousCurve part;
  part.degree = p;
  part.dim = dim;
  part.domain = {low, high, false};
  part.points.assign(all.points.begin() + (first - p), all.points.begin() + last + 1);
  part.knots.assign(index_of(p + 1), Knot{0, low});
  for (int i = first + 1; i <= last; ++i) {
    part.knots.push_back({0, domain.rounded(all.knots[index_of(i)])});  // in the domain: exact
  }
  part.knots.insert(part.knots.end(), index_of(p + 1), Knot{0, high});
  return part;
}

void HomogeneousCurve::round_to(CurveSpec& spec) const {
  spec.knots.clear();
  for (const Knot& knot : knots) spec.knots.push_back(domain.rounded(knot));
  spec.points.resize(points.size() * index_of(dim));
  spec.weights.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].project(std::span(spec.points).subspan(i * index_of(dim), index_of(dim)));
    spec.weights[i] = points[i].w.hi;
  }
}

void HomogeneousCurve::write_to(CurveSpec& spec) const {
  round_to(spec);
  if (!domain.periodic) return;
  const auto p = index_of(degree), n = points.size() - p;
  spec.points.resize(n * index_of(dim));
  spec.weights.resize(n);
  spec.knots.resize(n + p + 1);
  spec.knots.erase(spec.knots.begin(), spec.knots.begin() + degree);
}

void bezier_points(const HomogeneousCurve& curve, int span,
                   std::span<HomogeneousPoint> out) noexcept {
  bezier_points(curve, span, curve.knots[index_of(span)], curve.knots[index_of(span + 1)], out);
}

void bezier_points(const HomogeneousCurve& curve, int span, Knot left, Knot right,
                   std::span<HomogeneousPoint> out) noexcept {
  const int p = curve.degree;
  const DoubleDouble width = curve.domain.distance(left, right);
  std::copy_n(curve.points.begin() + (span - p), p + 1, out.begin());
  // As the blossom f(left^l, ...): after p levels out[j] = f(left^{p-j}, the j knots to the right).
  // Level l blends neighbours whose knots differ in one place; point j of it lands in out[j].
  for (int l = 1; l <= p; ++l) {
    for (int j = 0; j <= p - l; ++j) {
      out[index_of(j)] = blend(out[index_of(j)], out[index_of(j + 1)],
                               curve.domain.distance(curve.knots[index_of(span - p + l + j)], left),
                               curve.domain.distance(left, curve.knots[index_of(span + 1 + j)]));
    }
  }
  // Then f(left^{p-j}, right^j): the knots right of the span give way to its end.
  for (int l = 1; l <= p; ++l) {
    for (int j = p; j >= l; --j) {
      out[index_of(j)] =
          blend(out[index_of(j - 1)], out[index_of(j)], width,
                curve.domain.distance(right, curve.knots[index_of(span + 1 + j - l)]));
    }
  }
}

}  // namespace knotwave::curves
