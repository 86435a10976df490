// SPDX-License-Identifier: MIT
#include "bernstein.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/index.h"

namespace knotwave::curves {
namespace {

using base::index_of;
int degree_of(std::span<const DoubleDouble> a) { return static_cast<int>(a.size()) - 1; }

/// A polynomial over [low, high] that sign_changes() looks at.
struct Part {
  Bernstein of;
  Bernstein noise;  ///< each coefficient up to this is rounding
  double low = 0;
  double high = 1;
};

struct Signs {
  int first = 0;  ///< of the first coefficient that is not 0; 0 = all are
  int last = 0;
  int changes = 0;
};

Signs signs_of(const Part& part) {
  Signs signs;
  for (std::size_t i = 0; i < part.of.size(); ++i) {
    const double x = part.of[i].hi;
    if (std::abs(x) <= part.noise[i].hi) continue;
    const int sign = x > 0 ? 1 : -1;
    if (signs.first == 0) signs.first = sign;
    if (signs.last != 0 && sign != signs.last) ++signs.changes;
    signs.last = sign;
  }
  return signs;
}

double bisect(const Bernstein& whole, double low, double high, int sign_below) {
  constexpr int kMostSteps = 120;  // 54 for a root beyond 1/2, more towards 0
  for (int i = 0; i < kMostSteps && high - low > 0x1p-54 * high; ++i) {
    const double middle = 0.5 * (low + high);
    const double value = scaled_value(whole, middle).hi;
    const bool below = sign_below > 0 ? value > 0 : value < 0;
    (below ? low : high) = middle;
  }
  return high;
}

void search_part(const Bernstein& whole, Part part, std::vector<double>& found) {
  const Signs signs = signs_of(part);
  if (signs.changes == 0) return;
  if (signs.changes == 1) {
    found.push_back(bisect(whole, part.low, part.high, signs.first));
    return;
  }
  const double middle = 0.5 * (part.low + part.high);
  constexpr double kShortest = 0x1p-50, kFirst = 0x1p-64;
  if (part.high - part.low <= std::max(kShortest * part.high, kFirst)) {
    found.push_back(middle);
    return;
  }
  Part right{halve(part.of), halve(part.noise), middle, part.high};
  part.high = middle;
  const int before = signs_of(part).last, after = signs_of(right).first;
  search_part(whole, std::move(part), found);
  // A root on the cut is in neither half.
  if (before * after < 0) found.push_back(middle);
  search_part(whole, std::move(right), found);
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

DoubleDouble scaled_value(std::span<const DoubleDouble> a, DoubleDouble t) noexcept {
  // Horner in t / (1 - t), or from the other end in (1 - t) / t: neither is above 1.
  const int n = degree_of(a);
  const bool early = t.hi <= 0.5;
  const DoubleDouble rest = DoubleDouble(1.0) - t;
  const DoubleDouble ratio = early ? t / rest : rest / t;
  DoubleDouble sum = early ? a.back() : a.front();
  double choose = 1;
  for (int k = 1; k <= n; ++k) {
    choose = choose * (n - k + 1) / k;
    sum = sum * ratio + a[index_of(early ? n - k : k)] * DoubleDouble(choose);
  }
  return sum;
}

DoubleDouble quotient_at(const Bernstein& numerator, const Bernstein& denominator,
                         DoubleDouble t) noexcept {
  if (t.hi <= 0) return numerator.front() / denominator.front();
  if ((DoubleDouble(1.0) - t).hi <= 0) return numerator.back() / denominator.back();
  return scaled_value(numerator, t) / scaled_value(denominator, t);
}

std::vector<double> sign_changes(const Bernstein& a, const Bernstein& terms) {
  Bernstein noise = terms;
  for (DoubleDouble& x : noise) x = DoubleDouble(0x1p-96 * x.hi);
  std::vector<double> found;
  search_part(a, {a, std::move(noise)}, found);
  return found;
}

Bernstein derivative_terms(const Bernstein& w) {
  Bernstein terms;
  for (std::size_t i = 0; i + 1 < w.size(); ++i) {
    terms.push_back((w[i + 1] + w[i]) * DoubleDouble(static_cast<double>(w.size() - 1)));
  }
  return terms;
}

}  // namespace knotwave::curves
