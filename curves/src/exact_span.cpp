// SPDX-License-Identifier: MIT
#include "exact_span.h"

#include <algorithm>

namespace knotwave::curves {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool are_equal(const std::vector<BigFloat>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(),
                     [&](const BigFloat& x) { return (x - numbers.front()).sign() == 0; });
}

/// For each number the product of all others; none where they are equal, as the product is then.
std::vector<BigFloat> products_of_others(const std::vector<BigFloat>& numbers) {
  if (are_equal(numbers)) return {};
  std::vector<BigFloat> products(numbers.size(), BigFloat(1.0));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (std::size_t j = 0; j < numbers.size(); ++j) {
      if (j != i) products[i] = products[i] * numbers[j];
    }
  }
  return products;
}

}  // namespace

ExactSpan::ExactSpan(const NurbsCurve& curve, double u0)
    : curve_(&curve), span_(find_span(curve.knots(), curve.degree(), u0, Side::right)) {
  const int p = curve.degree();
  for (int k = span_ - p + 1; k <= span_ + p; ++k) knots_.push_back(curve.knots()[at(k)]);
  for (int level = 1; level <= p; ++level) {
    std::vector<BigFloat> widths;
    for (int j = level; j <= p; ++j)
      widths.push_back(knots_[at(j + p - level)] - knots_[at(j - 1)]);
    share_.push_back(products_of_others(widths));
  }
}

ExactSpan::Row ExactSpan::row(int c, double origin) const {
  Row row;
  for (int j = span_ - curve_->degree(); j <= span_; ++j) {
    const BigFloat weight = curve_->weights()[at(j)];
    if (c == curve_->dim()) {
      row.push_back(weight);
      continue;
    }
    BigFloat x = curve_->points()[at(j * curve_->dim() + c)];
    if (c == 0) x = x - BigFloat(origin);
    row.push_back(weight * x);
  }
  return row;
}

BigFloat ExactSpan::knot_of(const BigFloat& t) const {
  const BigFloat& u0 = knots_[at(curve_->degree() - 1)];
  return u0 + t * (knots_[at(curve_->degree())] - u0);
}

BigFloat ExactSpan::blossom(Row points, const BigFloat& a, const BigFloat& b, int count) const {
  const int p = curve_->degree();
  for (int level = 1; level <= p; ++level) {
    const BigFloat& u = level <= count ? b : a;
    const std::vector<BigFloat>& share = share_[at(level - 1)];
    for (int j = p; j >= level; --j) {
      BigFloat& point = points[at(j)];
      point = (knots_[at(j + p - level)] - u) * points[at(j - 1)] + (u - knots_[at(j - 1)]) * point;
      if (!share.empty()) point = point * share[at(j - level)];
    }
  }
  return points.back();
}

int ExactSpan::time_sign(double x, const BigFloat& t) const {
  return blossom(row(0, x), knot_of(t), {}, 0).sign();
}

BigFloat ExactSpan::place_of(double x, BigFloat low, BigFloat high) const {
  const Row time = row(0, x);
  const BigFloat half = 0.5, enough = BigFloat::power_of_two(-kPlaceBits);
  while ((high - low - enough).sign() > 0) {
    const BigFloat middle = (low + high) * half;
    const int sign = blossom(time, knot_of(middle), {}, 0).sign();
    if (sign == 0) return middle;
    (sign < 0 ? low : high) = middle;
  }
  return low;
}

SpanPolynomial ExactSpan::part(const BigFloat& from, const BigFloat& to, double origin,
                               bool negated) const {
  const int p = curve_->degree(), dim = curve_->dim();
  const BigFloat a = knot_of(from), b = knot_of(to);
  std::vector<BigFloat> all;
  for (int c = 0; c <= dim; ++c) {
    const Row points = row(c, origin);
    for (int m = 0; m <= p; ++m) {
      const BigFloat x = blossom(points, a, b, m);
      all.push_back(c == 0 && negated ? -x : x);
    }
  }
  int size = all.back().magnitude();  // of the weights
  for (int m = 0; m <= p; ++m) size = std::max(size, all[all.size() - 1 - at(m)].magnitude());
  SpanPolynomial span;
  span.degree = p;
  span.dim = dim;
  for (const BigFloat& x : all) span.bezier.push_back(x.rounded(size));
  span.rows.resize(span.bezier.size());
  for (int c = 0; c <= dim; ++c) {
    const auto row = span.bezier_row(c);
    std::vector<DoubleDouble> bernstein(row.begin(), row.end());
    bernstein_to_powers(bernstein, std::span(span.rows).subspan(at(c * (p + 1)), at(p + 1)));
  }
  return span;
}

SpanPolynomial ExactSpan::after(const BigFloat& t, double origin) const {
  return part(t, 1.0, origin, false);
}

SpanPolynomial ExactSpan::before(const BigFloat& t, double origin) const {
  return part(t, 0.0, origin, true);
}

}  // namespace knotwave::curves
