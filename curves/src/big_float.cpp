// SPDX-License-Identifier: MIT
#include "big_float.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scaled_double.h"

namespace knotwave::curves {
namespace {

constexpr int kLimbBits = 32;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

BigFloat::BigFloat(Limbs limbs, int exponent, bool is_negative)
    : limbs_(std::move(limbs)), exponent_(exponent), is_negative_(is_negative) {
  while (!limbs_.empty() && limbs_.back() == 0) limbs_.pop_back();
  std::size_t drop = limbs_.size() > kMostLimbs ? limbs_.size() - kMostLimbs : 0;
  while (drop < limbs_.size() && limbs_[drop] == 0) ++drop;
  limbs_.erase(limbs_.begin(), limbs_.begin() + static_cast<std::ptrdiff_t>(drop));
  exponent_ += static_cast<int>(drop);
}

BigFloat::BigFloat(double value) {
  double rest = std::abs(value);
  if (rest == 0) return;
  // To below 2^32 by whole limbs, then limb after limb from above.
  int exponent = 0;
  for (; rest >= 0x1p32; rest *= 0x1p-32) ++exponent;
  for (; rest < 1; rest *= 0x1p32) --exponent;
  Limbs limbs;
  for (; rest > 0; --exponent) {
    const double whole = std::floor(rest);
    limbs.push_back(static_cast<std::uint32_t>(whole));
    rest = (rest - whole) * 0x1p32;
  }
  std::reverse(limbs.begin(), limbs.end());
  *this = BigFloat(std::move(limbs), exponent + 1, value < 0);
}

BigFloat::BigFloat(DoubleDouble value) { *this = BigFloat(value.hi) + BigFloat(value.lo); }

BigFloat BigFloat::power_of_two(int exponent) {
  const int limb = (exponent - ((exponent % kLimbBits + kLimbBits) % kLimbBits)) / kLimbBits;
  return {{std::uint32_t{1} << (exponent - limb * kLimbBits)}, limb, false};
}

int BigFloat::magnitude() const {
  return limbs_.empty() ? std::numeric_limits<int>::min()
                        : exponent_ + static_cast<int>(limbs_.size());
}

DoubleDouble BigFloat::rounded(int e) const {
  constexpr int kLeast = -31;
  constexpr int kLimbsOfDoubleDouble = 5;
  DoubleDouble sum = 0.0;
  if (limbs_.empty()) return sum;
  for (int i = magnitude() - 1; i >= magnitude() - kLimbsOfDoubleDouble && i - e >= kLeast; --i) {
    sum += DoubleDouble(static_cast<double>(limb(i)) * curves::power_of_two((i - e) * kLimbBits));
  }
  return is_negative_ ? -sum : sum;
}

std::uint32_t BigFloat::limb(int e) const {
  return e < exponent_ || e >= magnitude() ? 0 : limbs_[at(e - exponent_)];
}

BigFloat BigFloat::operator-() const {
  BigFloat negative = *this;
  negative.is_negative_ = !is_negative_;
  return negative;
}

bool BigFloat::is_smaller(const BigFloat& a, const BigFloat& b) {
  if (a.magnitude() != b.magnitude()) return a.magnitude() < b.magnitude();
  const int least = std::min(a.exponent_, b.exponent_);
  for (int e = a.magnitude() - 1; e >= least; --e) {
    if (a.limb(e) != b.limb(e)) return a.limb(e) < b.limb(e);
  }
  return false;
}

BigFloat operator+(const BigFloat& a, const BigFloat& b) {
  if (a.sign() == 0) return b;
  if (b.sign() == 0) return a;
  if (BigFloat::is_smaller(a, b)) return b + a;
  // Of b, what is far below a is beyond the last limb of the sum.
  const int top = a.magnitude();
  const int least = std::max(std::min(a.exponent_, b.exponent_),
                             top - static_cast<int>(BigFloat::kMostLimbs) - 1);
  const bool is_sum = a.is_negative_ == b.is_negative_;
  BigFloat::Limbs limbs;
  std::int64_t carry = 0;
  for (int e = least; e <= top; ++e) {
    const std::int64_t other = b.limb(e);
    const std::int64_t now = carry + std::int64_t{a.limb(e)} + (is_sum ? other : -other);
    limbs.push_back(static_cast<std::uint32_t>(now & 0xffffffff));
    carry = now < 0 ? -1 : now >> kLimbBits;
  }
  return {std::move(limbs), least, a.is_negative_};
}

BigFloat operator*(const BigFloat& a, const BigFloat& b) {
  if (a.sign() == 0 || b.sign() == 0) return {};
  BigFloat::Limbs limbs(a.limbs_.size() + b.limbs_.size(), 0);
  for (std::size_t i = 0; i < a.limbs_.size(); ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < b.limbs_.size(); ++j) {
      carry += limbs[i + j] + std::uint64_t{a.limbs_[i]} * b.limbs_[j];
      limbs[i + j] = static_cast<std::uint32_t>(carry & 0xffffffff);
      carry >>= kLimbBits;
    }
    limbs[i + b.limbs_.size()] = static_cast<std::uint32_t>(carry);
  }
  return {std::move(limbs), a.exponent_ + b.exponent_, a.is_negative_ != b.is_negative_};
}

}  // namespace knotwave::curves
