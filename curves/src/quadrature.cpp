// SPDX-License-Identifier: MIT
#include "quadrature.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/gauss_legendre.h"

#include "length.h"
#include "span_polynomial.h"

namespace knotwave::curves {
namespace {

constexpr double kRadius = 2.125;  // (4 + 1/4) / 2: the ellipse's longer half axis
constexpr double kWander = 0.4;    // of the value in the middle; below sqrt(2) - 1
constexpr double kRatioGrowth = 64;

/// How far a polynomial in powers of the distance from the middle may move within the disc.
double wander(std::span<const DoubleDouble> powers) {
  double sum = 0, radius = 1;
  for (std::size_t k = 1; k < powers.size(); ++k) {
    radius *= kRadius;
    sum += std::abs(powers[k].hi) * radius;
  }
  return sum;
}

double largest(const Bernstein& a) {
  double most = 0;
  for (const DoubleDouble& x : a) most = std::max(most, std::abs(x.hi));
  return most;
}

double least(const Bernstein& a) {
  return std::min_element(a.begin(), a.end(),
                          [](DoubleDouble x, DoubleDouble y) { return x.hi < y.hi; })
      ->hi;
}

}  // namespace

class QuadratureSearch {
 public:
  QuadratureSearch(const Integrand& integrand, double negligible)
      : kind_(integrand.kind), negligible_(negligible) {
    search(integrand, 0, 1);
  }
  std::vector<QuadraturePart> take() { return std::move(parts_); }

 private:
  void search(Integrand part, double start, double width) {
    const double bound = width * bound_of(part);
    if (!(bound > negligible_)) {
      add(start, width).flat_ = kind_ == Integrand::Kind::speed ? 0.5 * bound / width : 0;
      return;
    }
    if (accept(part, start, width)) return;
    Integrand right{kind_, {}, halve(part.bottom)};
    for (Bernstein& top : part.tops) right.tops.push_back(halve(top));
    search(std::move(part), start, 0.5 * width);
    search(std::move(right), start + 0.5 * width, 0.5 * width);
  }

  /// The integrand is nowhere larger.
  double bound_of(const Integrand& part) const {
    std::vector<double> tops;
    for (const Bernstein& top : part.tops) tops.push_back(largest(top));
    const double below = least(part.bottom);
    return kind_ == Integrand::Kind::speed ? length_of(tops) / below / below : tops[0] / below;
  }

  bool accept(const Integrand& part, double start, double width) {
    QuadraturePart found;
    found.bottom_ = centered_powers(part.bottom);
    if (!(wander(found.bottom_) <= kWander * found.bottom_[0].hi)) return false;
    std::vector<double> middle, moves;
    for (const Bernstein& top : part.tops) {
      found.tops_.push_back(centered_powers(top));
      middle.push_back(found.tops_.back()[0].hi);
      moves.push_back(wander(found.tops_.back()));
    }
    const double most = kind_ == Integrand::Kind::speed ? kWander * length_of(middle)
                                                        : kRatioGrowth * largest(part.tops[0]);
    if (!(length_of(moves) <= most)) return false;
    QuadraturePart& kept = add(start, width);
    kept.tops_ = std::move(found.tops_);
    kept.bottom_ = std::move(found.bottom_);
    return true;
  }

  QuadraturePart& add(double start, double width) {
    QuadraturePart& part = parts_.emplace_back();
    part.start = start;
    part.width = width;
    part.kind_ = kind_;
    return part;
  }

  Integrand::Kind kind_;
  double negligible_;
  std::vector<QuadraturePart> parts_;
};

double QuadraturePart::value(double share) const {
  if (tops_.empty()) return flat_;
  const DoubleDouble s = DoubleDouble::sum(2 * share, -1);
  const DoubleDouble below = polynomial_at(bottom_, s);
  if (kind_ == Integrand::Kind::ratio) return (polynomial_at(tops_[0], s) / below).hi;
  DoubleDouble square = 0.0;
  for (const auto& top : tops_) {
    const DoubleDouble x = polynomial_at(top, s);
    square += x * x;
  }
  return std::sqrt(square.hi) / below.hi / below.hi;
}

DoubleDouble QuadraturePart::integral(DoubleDouble share) const {
  DoubleDouble sum = 0.0;
  for (const base::GaussNode& node : base::kGaussLegendre16) {
    for (const double sign : {-1.0, 1.0}) {
      const DoubleDouble place = share * DoubleDouble::sum(0.5, sign * node.distance);
      sum += DoubleDouble(node.weight) * DoubleDouble(value(place.hi));
    }
  }
  return sum * share * DoubleDouble(width);
}

std::vector<QuadraturePart> quadrature_parts(const Integrand& integrand, double negligible) {
  return QuadratureSearch(integrand, negligible).take();
}

}  // namespace knotwave::curves
