// SPDX-License-Identifier: MIT
#include "bernstein.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/index.h"

namespace knotwave::curves {
namespace {

using base::index_of;
int degree_of(std::span<const DoubleDouble> a) { return static_cast<int>(a.size()) - 1; }

/// What sign_changes() works with.
struct Search {
  const Bernstein& whole;
  double noise;  ///< coefficients up to this are rounding
  std::vector<double>& found;

  int sign(DoubleDouble x) const { return x.hi > noise ? 1 : x.hi < -noise ? -1 : 0; }
};

struct Signs {
  int first = 0;  ///< of the first coefficient that is not 0; 0 = all are
  int last = 0;
  int changes = 0;
};

Signs signs_of(const Search& search, const Bernstein& part) {
  Signs signs;
  for (const DoubleDouble& x : part) {
    const int sign = search.sign(x);
    if (sign == 0) continue;
    if (signs.first == 0) signs.first = sign;
    if (signs.last != 0 && sign != signs.last) ++signs.changes;
    signs.last = sign;
  }
  return signs;
}

double bisect(const Search& search, double low, double high, int sign_below) {
  constexpr int kSteps = 54;
  for (int i = 0; i < kSteps; ++i) {
    const double middle = 0.5 * (low + high);
    const double value = scaled_value(search.whole, middle).hi;
    const bool below = sign_below > 0 ? value > 0 : value < 0;
    (below ? low : high) = middle;
  }
  return high;
}

void search_part(const Search& search, Bernstein part, double low, double high) {
  const Signs signs = signs_of(search, part);
  if (signs.changes == 0) return;
  if (signs.changes == 1) {
    search.found.push_back(bisect(search, low, high, signs.first));
    return;
  }
  const double middle = 0.5 * (low + high);
  constexpr double kShortest = 0x1p-50;
  if (high - low <= kShortest) {
    search.found.push_back(middle);
    return;
  }
  Bernstein right = halve(part);
  const int before = signs_of(search, part).last, after = signs_of(search, right).first;
  search_part(search, std::move(part), low, middle);
  // A root on the cut is in neither half.
  if (before * after < 0) search.found.push_back(middle);
  search_part(search, std::move(right), middle, high);
}

}  // namespace

Bernstein operator*(const Bernstein& a, const Bernstein& b) {
  const int m = degree_of(a), n = degree_of(b);
  Bernstein product(index_of(m + n + 1));
  double choose_i = 1;  // of m; all binomials here are whole numbers below 2^53
  for (int i = 0; i <= m; ++i) {
    double choose_j = 1;  // of n
    for (int j = 0; j <= n; ++j) {
      product[index_of(i + j)] +=
          a[index_of(i)] * b[index_of(j)] * (DoubleDouble(choose_i) * DoubleDouble(choose_j));
      choose_j = choose_j * (n - j) / (j + 1);
    }
    choose_i = choose_i * (m - i) / (i + 1);
  }
  double choose = 1;  // of m + n
  for (int k = 0; k <= m + n; ++k) {
    product[index_of(k)] = product[index_of(k)] / DoubleDouble(choose);
    choose = choose * (m + n - k) / (k + 1);
  }
  return product;
}

Bernstein operator+(const Bernstein& a, const Bernstein& b) {
  Bernstein sum = a;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += b[i];
  return sum;
}

Bernstein operator-(const Bernstein& a, const Bernstein& b) {
  Bernstein difference = a;
  for (std::size_t i = 0; i < a.size(); ++i) difference[i] += -b[i];
  return difference;
}

Bernstein derivative(const Bernstein& a) {
  Bernstein slopes;
  for (std::size_t i = 0; i + 1 < a.size(); ++i) {
    slopes.push_back((a[i + 1] - a[i]) * DoubleDouble(static_cast<double>(a.size() - 1)));
  }
  return slopes;
}

Bernstein halve(Bernstein& a) {
  Bernstein right = a;
  for (std::size_t level = 1; level < a.size(); ++level) {
    for (std::size_t r = 0; r + level < a.size(); ++r) {
      const DoubleDouble sum = right[r] + right[r + 1];
      right[r] = DoubleDouble(0.5 * sum.hi, 0.5 * sum.lo);
    }
    a[level] = right[0];
  }
  return right;
}

std::vector<DoubleDouble> centered_powers(Bernstein a) {
  // a_k = C(n, k) 2^-k D, where D, the k-th differences at 1/2, is sum C(n-k, j) d_j 2^-(n-k).
  const int n = degree_of(a);
  double scale = 1;
  for (int k = 0; k < n; ++k) scale *= 0.5;
  std::vector<DoubleDouble> powers;
  double choose_k = 1;  // C(n, k)
  for (int k = 0; k <= n; ++k) {
    DoubleDouble sum = 0.0;
    double choose_j = 1;  // C(n - k, j)
    for (int j = 0; j <= n - k; ++j) {
      sum += a[index_of(j)] * DoubleDouble(choose_j);
      choose_j = choose_j * (n - k - j) / (j + 1);
      if (j < n - k) a[index_of(j)] = a[index_of(j + 1)] - a[index_of(j)];
    }
    powers.push_back(sum * DoubleDouble(choose_k * scale));
    choose_k = choose_k * (n - k) / (k + 1);
  }
  return powers;
}

Bernstein part_of(Bernstein a, DoubleDouble t0, DoubleDouble t1) {
  // de Casteljau at t1 keeps the left part, then at t0 / t1 the right part of that.
  const std::size_t n = a.size() - 1;
  const DoubleDouble beyond = DoubleDouble(1.0) - t1;
  for (std::size_t level = 1; level <= n; ++level) {
    for (std::size_t j = n; j >= level; --j) a[j] = a[j - 1] * beyond + a[j] * t1;
  }
  const DoubleDouble share = t0 / t1, rest = (t1 - t0) / t1;
  for (std::size_t level = 1; level <= n; ++level) {
    for (std::size_t j = 0; j + level <= n; ++j) a[j] = a[j] * rest + a[j + 1] * share;
  }
  return a;
}

DoubleDouble scaled_value(std::span<const DoubleDouble> a, double t) noexcept {
  // Horner in t / (1 - t), or from the other end in (1 - t) / t: neither is above 1.
  const int n = degree_of(a);
  const bool early = t <= 0.5;
  const DoubleDouble rest = DoubleDouble::difference(1, t);
  const DoubleDouble ratio = early ? DoubleDouble(t) / rest : rest / DoubleDouble(t);
  DoubleDouble sum = early ? a.back() : a.front();
  double choose = 1;
  for (int k = 1; k <= n; ++k) {
    choose = choose * (n - k + 1) / k;
    sum = sum * ratio + a[index_of(early ? n - k : k)] * DoubleDouble(choose);
  }
  return sum;
}

DoubleDouble quotient_at(const Bernstein& numerator, const Bernstein& denominator,
                         double t) noexcept {
  if (t <= 0) return numerator.front() / denominator.front();
  if (t >= 1) return numerator.back() / denominator.back();
  return scaled_value(numerator, t) / scaled_value(denominator, t);
}

std::vector<double> sign_changes(const Bernstein& a) {
  double largest = 0;
  for (const DoubleDouble& x : a) largest = std::max(largest, std::abs(x.hi));
  std::vector<double> found;
  search_part({a, 0x1p-96 * largest, found}, a, 0, 1);
  return found;
}

}  // namespace knotwave::curves
