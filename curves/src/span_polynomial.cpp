// SPDX-License-Identifier: MIT
#include "span_polynomial.h"

#include <algorithm>

namespace knotwave::curves {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

void bernstein_to_powers(std::vector<DoubleDouble>& b, std::span<DoubleDouble> out) {
  const int degree = static_cast<int>(b.size()) - 1;
  double choose = 1;
  for (int k = 0; k <= degree; ++k) {
    out[at(k)] = b[0] * DoubleDouble(choose);
    for (int j = 0; j + 1 <= degree - k; ++j) b[at(j)] = b[at(j) + 1] - b[at(j)];
    choose = choose * (degree - k) / (k + 1);  // whole numbers
  }
}

std::vector<SpanPolynomial> span_polynomials(const HomogeneousCurve& curve) {
  const int p = curve.degree;
  std::vector<SpanPolynomial> spans;
  std::vector<HomogeneousPoint> points(at(p + 1));
  std::vector<DoubleDouble> bernstein(at(p + 1));
  for (int i = p; i < static_cast<int>(curve.points.size()); ++i) {
    const double u0 = curve.domain.rounded(curve.knots[at(i)]);
    const double u1 = curve.domain.rounded(curve.knots[at(i) + 1]);
    if (!(u0 < u1)) continue;
    bezier_points(curve, i, points);
    SpanPolynomial span;
    span.u0 = u0;
    span.u1 = u1;
    span.degree = p;
    span.dim = curve.dim;
    span.is_whole = curve.points.size() == at(p + 1) && curve.knots.front() == curve.knots[at(p)] &&
                    curve.knots.back() == curve.knots[at(p + 1)];
    span.rows.resize(at((curve.dim + 1) * (p + 1)));
    span.bezier.reserve(span.rows.size());
    for (int c = 0; c <= curve.dim; ++c) {
      for (int r = 0; r <= p; ++r) {
        bernstein[at(r)] = c < curve.dim ? points[at(r)].x[at(c)] : points[at(r)].w;
      }
      span.bezier.insert(span.bezier.end(), bernstein.begin(), bernstein.end());
      bernstein_to_powers(bernstein, std::span(span.rows).subspan(at(c * (p + 1)), at(p + 1)));
    }
    const auto weight = span.row(curve.dim);
    span.has_weights = weight[0].hi != 1 || std::any_of(weight.begin() + 1, weight.end(),
                                                        [](DoubleDouble w) { return w.hi != 0; });
    spans.push_back(std::move(span));
  }
  return spans;
}

DoubleDouble polynomial_at(std::span<const DoubleDouble> c, DoubleDouble t) noexcept {
  DoubleDouble sum = c.back();
  for (std::size_t k = c.size() - 1; k-- > 0;) sum = sum * t + c[k];
  return sum;
}

DoubleDouble polynomial_slope_at(std::span<const DoubleDouble> c, DoubleDouble t) noexcept {
  DoubleDouble sum = 0.0;
  for (std::size_t k = c.size() - 1; k > 0; --k) {
    sum = sum * t + c[k] * DoubleDouble(static_cast<double>(k));
  }
  return sum;
}

DoubleDouble coordinate_at(const SpanPolynomial& span, int coordinate, DoubleDouble t) noexcept {
  const DoubleDouble value = polynomial_at(span.row(coordinate), t);
  return span.has_weights ? value / polynomial_at(span.row(span.dim), t) : value;
}

DoubleDouble coordinate_slope_at(const SpanPolynomial& span, int coordinate,
                                 DoubleDouble t) noexcept {
  const DoubleDouble slope = polynomial_slope_at(span.row(coordinate), t);
  if (!span.has_weights) return slope;
  const auto weight = span.row(span.dim);
  return (slope - coordinate_at(span, coordinate, t) * polynomial_slope_at(weight, t)) /
         polynomial_at(weight, t);
}

}  // namespace knotwave::curves
