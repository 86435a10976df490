// SPDX-License-Identifier: MIT
// A decay that is straight in decibels, from one rational segment. With v = u - 1/2 and x = L v /
// 2, e^(-L v) is (1 - tanh x) / (1 + tanh x), so q(-v) / q(v) with q = E(x^2) + x O(x^2) is as near
// to it as x O / E is to tanh x. O = c0 + c1 x^2 and E = 1 + b1 x^2 + b2 x^4 are found from four
// places where they meet tanh; the last one is the end of the curve, the others are moved until the
// ripples between them are equally high. By symmetry that settles negative v, too.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "knotwave/base/document.h"
#include "knotwave/base/elementary.h"
#include "knotwave/curves/shapes.h"

#include "double_double.h"

namespace knotwave::curves {
namespace {

constexpr DoubleDouble kLog10{0x1.26bb1bbb55516p+1, -0x1.f48ad494ea3e9p-53};
constexpr std::size_t kNodes = 4;
using Nodes = std::array<double, kNodes>;     // v, rising, the last one 1/2
using Factors = std::array<DoubleDouble, 4>;  // c0, c1, b1, b2

// x / (1 + x^2 / (3 + x^2 / (5 + ...))): |x| <= 3.5 needs fewer than 30 terms for 2^-100.
DoubleDouble tanh_of(DoubleDouble x) {
  const DoubleDouble square = x * x;
  DoubleDouble bottom = 61.0;
  for (int odd = 59; odd >= 1; odd -= 2) bottom = DoubleDouble(odd) + square / bottom;
  return x / bottom;
}

template <class Number, std::size_t n>
std::array<Number, n> solve(std::array<std::array<Number, n>, n> a, std::array<Number, n> b) {
  const auto size = [](const Number& number) { return std::abs(DoubleDouble(number).hi); };
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (size(a[i][k]) > size(a[pivot][k])) pivot = i;
    }
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const Number share = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] = a[i][j] - share * a[k][j];
      b[i] = b[i] - share * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] = b[k] - a[k][j] * b[j];
    b[k] = b[k] / a[k][k];
  }
  return b;
}

Factors factors_through(DoubleDouble length, const Nodes& nodes) {
  std::array<std::array<DoubleDouble, 4>, 4> rows;
  std::array<DoubleDouble, 4> right;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const DoubleDouble x = length * DoubleDouble(nodes[i] / 2), square = x * x;
    const DoubleDouble t = tanh_of(x);
    rows[i] = {x, x * square, -(t * square), -(t * square * square)};
    right[i] = t;
  }
  return solve(rows, right);
}

// How far the logarithm of the curve is from the line at v, to first order.
double ripple_at(DoubleDouble length, const Factors& f, double v) {
  const DoubleDouble x = length * DoubleDouble(v / 2), square = x * x;
  const DoubleDouble t = tanh_of(x);
  const DoubleDouble odd = x * (f[0] + f[1] * square);
  const DoubleDouble even = DoubleDouble(1.0) + square * (f[2] + f[3] * square);
  return ((odd / even - t) / (DoubleDouble(1.0) - t * t)).hi;
}

// log2 of the highest place of each ripple.
std::array<double, kNodes> ripples(DoubleDouble length, const Nodes& nodes) {
  constexpr int kPlaces = 32;
  const Factors factors = factors_through(length, nodes);
  std::array<double, kNodes> highest{};
  double from = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    double high = 0;
    for (int place = 1; place < kPlaces; ++place) {
      const double v = from + (nodes[i] - from) * place / kPlaces;
      high = std::max(high, std::abs(ripple_at(length, factors, v)));
    }
    highest[i] = base::log2(high);
    from = nodes[i];
  }
  return highest;
}

// Newton on the differences of neighbouring ripples; from 120 dB down, five steps leave less than
// 1e-9 of a ripple.
Nodes even_nodes(DoubleDouble length) {
  constexpr int kSteps = 5;
  constexpr double kMove = 0x1p-20;
  // The zeros of T9 above 0, stretched so that the last one is at 1/2.
  Nodes nodes{0.17364818, 0.32635182, 0.43969262, 0.5};
  for (int step = 0; step < kSteps; ++step) {
    const auto high = ripples(length, nodes);
    std::array<std::array<double, 3>, 3> slopes;
    std::array<double, 3> uneven;
    for (std::size_t i = 0; i < 3; ++i) uneven[i] = high[i + 1] - high[i];
    for (std::size_t j = 0; j < 3; ++j) {
      Nodes moved = nodes;
      moved[j] += kMove;
      const auto there = ripples(length, moved);
      for (std::size_t i = 0; i < 3; ++i) {
        slopes[i][j] = (there[i + 1] - there[i] - uneven[i]) / kMove;
      }
    }
    const auto change = solve(slopes, uneven);
    for (std::size_t j = 0; j < 3; ++j) nodes[j] -= change[j];
  }
  return nodes;
}

// The Bernstein coefficients of q over u in [0, 1]: those of its blossom with j arguments 1/2 and
// 4 - j arguments -1/2. The mean of the products of k out of these.
std::array<DoubleDouble, 5> bernstein(const std::array<DoubleDouble, 5>& powers_of_v) {
  std::array<DoubleDouble, 5> out;
  for (int j = 0; j <= 4; ++j) {
    // Elementary symmetric sums of the arguments, one after another.
    std::array<double, 5> sums{1, 0, 0, 0, 0};
    for (int i = 0; i < 4; ++i) {
      for (std::size_t k = 4; k >= 1; --k) sums[k] += (i < j ? 0.5 : -0.5) * sums[k - 1];
    }
    constexpr double kChoose[] = {1, 4, 6, 4, 1};
    DoubleDouble sum = 0.0;
    for (std::size_t k = 0; k <= 4; ++k) {
      sum += powers_of_v[k] * (DoubleDouble(sums[k]) / DoubleDouble(kChoose[k]));
    }
    out[static_cast<std::size_t>(j)] = sum;
  }
  return out;
}

double measured_error_db(const NurbsCurve& curve, double range_db) {
  constexpr int kPlaces = 4096;
  double highest = 0;
  for (int i = 0; i <= kPlaces; ++i) {
    const double u = static_cast<double>(i) / kPlaces;
    double value = 0;
    curve.evaluate(u, std::span(&value, 1));
    highest = std::max(highest, std::abs(base::gain_to_db(value) + range_db * u));
  }
  return highest * 1.001;
}

}  // namespace

Result<FittedDecay> exponential_decay(double range_db) {
  if (!(range_db >= 1 && range_db <= 120)) {
    return fail(ErrorCode::value_out_of_range, "a decay of " + base::number_text(range_db) +
                                                   " dB: the range must be within 1..120 dB");
  }
  const DoubleDouble length = kLog10 * DoubleDouble(range_db) / DoubleDouble(20.0);
  const Factors f = factors_through(length, even_nodes(length));
  const DoubleDouble half = length / DoubleDouble(2.0);
  const auto weights = bernstein({DoubleDouble(1.0), half * f[0], half * half * f[2],
                                  half * half * half * f[1], half * half * half * half * f[3]});
  // q(-v) has the same coefficients the other way round; at the middle the curve is -range_db / 2.
  const double middle = base::db_to_gain(-range_db / 2);
  CurveSpec spec;
  spec.name = "decay";
  spec.degree = 4;
  for (std::size_t j = 0; j <= 4; ++j) {
    spec.points.push_back((DoubleDouble(middle) * weights[4 - j] / weights[j]).hi);
    spec.weights.push_back((weights[j] / weights[4]).hi);
  }
  spec.points.front() = 1;
  spec.points[2] = middle;
  spec.points.back() = base::db_to_gain(-range_db);
  auto curve = NurbsCurve::create(std::move(spec));
  if (!curve) return std::move(curve).error();
  const double error = measured_error_db(*curve, range_db);
  return FittedDecay{std::move(*curve), error};
}

}  // namespace knotwave::curves
