// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "knotwave/base/index.h"

#include "homogeneous.h"

namespace knotwave::curves {
namespace {

using base::index_of;

// One coordinate of a rational Bézier segment: numerator a, denominator w.
struct Segment {
  double a[kMaxDegree + 1];
  double w[kMaxDegree + 1];
  int degree = 0;
  int depth = 0;

  double first() const { return a[0] / w[0]; }
  double last() const { return a[degree] / w[degree]; }
};

// de Casteljau at 1/2: the segment becomes its left half, the right one is returned.
Segment halve(Segment& segment) {
  Segment right = segment;
  const int p = segment.degree;
  segment.depth = right.depth = segment.depth + 1;
  for (int level = 1; level <= p; ++level) {
    for (int r = 0; r <= p - level; ++r) {
      right.a[r] = 0.5 * (right.a[r] + right.a[r + 1]);
      right.w[r] = 0.5 * (right.w[r] + right.w[r + 1]);
    }
    segment.a[level] = right.a[0];
    segment.w[level] = right.w[0];
  }
  return right;
}

struct Signs {
  double least = 0;  ///< smallest Bernstein coefficient of a' w - a w', over min(w)^2
  bool rises = false;
  bool falls = false;
};

// The derivative has the sign of a' w - a w', a polynomial of degree 2p - 1 whose Bernstein
// coefficients are sums over i + j = k of C(p-1, i) C(p, j) (a'_i w_j - a_j w'_i) / C(2p-1, k).
Signs derivative_signs(const Segment& segment, double origin) {
  const int p = segment.degree;
  const double least_w = *std::min_element(segment.w, segment.w + p + 1);
  double sums[2 * kMaxDegree] = {};
  double binomial_i = 1;  // C(p-1, i)
  for (int i = 0; i < p; ++i) {
    double binomial_j = 1;  // C(p, j)
    for (int j = 0; j <= p; ++j) {
      const double da =
          (segment.a[i + 1] - origin * segment.w[i + 1]) - (segment.a[i] - origin * segment.w[i]);
      const double dw = segment.w[i + 1] - segment.w[i];
      const double a = segment.a[j] - origin * segment.w[j];
      sums[i + j] += binomial_i * binomial_j * (da * segment.w[j] - a * dw);
      binomial_j = binomial_j * (p - j) / (j + 1);
    }
    binomial_i = binomial_i * (p - 1 - i) / (i + 1);
  }
  Signs signs;
  double binomial_k = 1;  // C(2p-1, k)
  for (int k = 0; k < 2 * p; ++k) {
    const double coefficient = p * sums[k] / binomial_k / (least_w * least_w);
    signs.least = std::min(signs.least, coefficient);
    signs.rises = signs.rises || coefficient > 0;
    signs.falls = signs.falls || coefficient < 0;
    binomial_k = binomial_k * (2 * p - 1 - k) / (k + 1);
  }
  return signs;
}

// Whether the segment goes back by more than `slack` somewhere. A segment is one unit of t long
// whatever its depth, so `least` bounds how far it can go back; each halving halves that bound.
bool goes_back(Segment segment, double slack) {
  const double start = segment.first();
  const Signs signs = derivative_signs(segment, start);
  if (!signs.falls || -signs.least <= slack) return false;
  if (!signs.rises) return start - segment.last() > slack;
  constexpr int kMaxDepth = 80;
  if (segment.depth == kMaxDepth) return false;
  const Segment right = halve(segment);
  return goes_back(segment, slack) || goes_back(right, slack);
}

}  // namespace

bool is_non_decreasing(const NurbsCurve& curve, int coordinate) {
  const HullRange hull = hull_range(curve, coordinate);
  // Sums of 2p products with p <= 15 are right to about 2^-46: below this a fall is not seen.
  const double slack = 0x1p-44 * std::max(std::abs(hull.low), std::abs(hull.high));
  double before = hull.low;
  for (const BezierSegment& bezier : to_bezier(curve)) {
    Segment segment;
    segment.degree = bezier.degree;
    for (int r = 0; r <= bezier.degree; ++r) {
      segment.w[r] = bezier.weights[index_of(r)];
      segment.a[r] = bezier.points[index_of(r * bezier.dim + coordinate)] * segment.w[r];
    }
    if (before - segment.first() > slack || goes_back(segment, slack)) return false;
    before = segment.last();
  }
  return true;
}

}  // namespace knotwave::curves
