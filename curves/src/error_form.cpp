// SPDX-License-Identifier: MIT
#include "error_form.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwave::curves {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Halving a form of degree 105 sixty times rounds away less than this of the bound.
constexpr double kRounding = 1 + 0x1p-36;
/// What a value of the curve by doubles is off by, of the hull's.
constexpr double kHullRoom = 0x1p-44;
constexpr int kMostHalvings = 60;

/// gap, value, weight as Bernstein coefficients over a part, one after the other.
struct Part {
  std::vector<double> rows;
  int halvings = 0;
};

Part whole(const ErrorForm& form) {
  const std::size_t count = form.weight.size();
  Part part{std::vector<double>(3 * count), 0};
  double choose = 1;
  for (std::size_t j = 0; j < count; ++j) {
    part.rows[j] = form.gap[j].hi / choose;
    part.rows[count + j] = form.value[j].hi / choose;
    part.rows[2 * count + j] = form.weight[j].hi / choose;
    choose = choose * double(count - 1 - j) / double(j + 1);
  }
  return part;
}

/// `part` becomes its left half, the right one is returned.
Part halved(Part& part) {
  Part right{part.rows, ++part.halvings};
  const std::size_t count = part.rows.size() / 3;
  for (std::size_t from = 0; from < part.rows.size(); from += count) {
    double* const r = right.rows.data() + from;
    for (std::size_t level = 1; level < count; ++level) {
      for (std::size_t j = 0; j + level < count; ++j) r[j] = 0.5 * (r[j] + r[j + 1]);
      part.rows[from + level] = r[0];
    }
  }
  return right;
}

/// The largest error that `count` coefficients from `first` on can mean. Above the hull, clamping
/// leaves high - curve of it, below it curve - low.
double hull_error(const Part& part, std::size_t first, std::size_t count,
                  const ErrorLimits& limits) {
  const std::size_t all = part.rows.size() / 3;
  const double* const gap = part.rows.data();
  const double* const value = gap + all;
  const double* const weight = value + all;
  double below = 0, above = 0, low = kInfinity, high = -kInfinity;
  for (std::size_t j = first; j < first + count; ++j) {
    const double share = 1 / weight[j];
    below = std::max(below, gap[j] * share);
    above = std::max(above, -gap[j] * share);
    low = std::min(low, value[j] * share);
    high = std::max(high, value[j] * share);
  }
  const double room = kHullRoom * std::max(std::abs(limits.low), std::abs(limits.high));
  return std::max(std::min(below, high - limits.low + room),
                  std::min(above, limits.high - low + room));
}

}  // namespace

ScaledBernstein scaled_one(int degree) {
  ScaledBernstein one(static_cast<std::size_t>(degree) + 1);
  DoubleDouble choose = 1.0;
  for (int j = 0; j <= degree; ++j) {
    one[static_cast<std::size_t>(j)] = choose;
    choose = choose * DoubleDouble(double(degree - j)) / DoubleDouble(double(j + 1));
  }
  return one;
}

ScaledBernstein scaled(std::span<const DoubleDouble> bernstein) {
  ScaledBernstein a(bernstein.begin(), bernstein.end());
  double choose = 1;  // whole numbers, the degree is a curve's
  for (std::size_t j = 0; j < a.size(); ++j) {
    a[j] = a[j] * DoubleDouble(choose);
    choose = choose * double(a.size() - 1 - j) / double(j + 1);
  }
  return a;
}

ScaledBernstein scaled_powers(std::span<const double> c) {
  // t^k = t^k (t + (1 - t))^(n - k).
  ScaledBernstein a(c.size());
  for (std::size_t k = 0; k < c.size(); ++k) {
    double choose = 1;
    for (std::size_t j = k; j < c.size(); ++j) {
      a[j] += DoubleDouble::product(c[k], choose);
      choose = choose * double(c.size() - 1 - j) / double(j - k + 1);
    }
  }
  return a;
}

ScaledBernstein convolved(std::span<const DoubleDouble> a, std::span<const DoubleDouble> b) {
  ScaledBernstein product(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
  }
  return product;
}

double error_bound(const ErrorForm& form, const ErrorLimits& limits) {
  std::vector<Part> open;
  open.push_back(whole(form));
  double found = limits.found, bound = 0;
  for (int parts = 0; !open.empty(); ++parts) {
    Part part = std::move(open.back());
    open.pop_back();
    const std::size_t count = form.weight.size();
    found =
        std::max({found, hull_error(part, 0, 1, limits), hull_error(part, count - 1, 1, limits)});
    if (!(found <= limits.most)) return kInfinity;
    const double upper = kRounding * hull_error(part, 0, count, limits);
    if (upper <= std::max({bound, limits.settled, kBoundRoom * found})) {
      bound = std::max(bound, upper);
    } else if (part.halvings == kMostHalvings || parts >= kMostParts) {
      if (!(upper <= limits.most)) return kInfinity;
      bound = std::max(bound, upper);
    } else {
      open.push_back(halved(part));
      open.push_back(std::move(part));
    }
  }
  return bound <= limits.most ? bound : kInfinity;
}

}  // namespace knotwave::curves
