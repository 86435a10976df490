// SPDX-License-Identifier: MIT
#include "knotwave/curves/reparametrize.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"
#include "knotwave/curves/algorithms.h"

#include "double_double.h"
#include "weights.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using base::number_text;

// Where the parameter k goes when [from_low, from_high] is stretched to [to_low, to_high]; the ends
// go exactly.
struct Stretch {
  double from_low, from_high;
  double to_low, to_high;

  double operator()(double k) const {
    if (k == from_low) return to_low;
    if (k == from_high) return to_high;
    const DoubleDouble fraction =
        DoubleDouble::difference(k, from_low) / DoubleDouble::difference(from_high, from_low);
    return (DoubleDouble(to_low) + fraction * DoubleDouble::difference(to_high, to_low)).hi;
  }
};

// `image` never goes back in the reals; neither may its rounding.
template <class Image>
void move_knots(CurveSpec& spec, const Image& image) {
  for (double& jump : spec.jumps) jump = image(jump);
  for (double& knot : spec.knots) knot = image(knot);
  for (std::size_t i = 1; i < spec.knots.size(); ++i) {
    spec.knots[i] = std::max(spec.knots[i], spec.knots[i - 1]);
  }
}

// A curve whose knots were moved. All that can be wrong with them is that they fell together.
Result<NurbsCurve> moved(CurveSpec spec) {
  auto curve = NurbsCurve::create(std::move(spec));
  if (curve || curve.error().code == ErrorCode::value_out_of_range) return curve;
  return fail(ErrorCode::knot_multiplicity,
              curve.error().message + " (knots that differed are equal after rounding)");
}

}  // namespace

Result<NurbsCurve> reverse(const NurbsCurve& curve) {
  CurveSpec spec = curve.spec();
  const double low = curve.u_min(), high = curve.u_max();
  std::reverse(spec.knots.begin(), spec.knots.end());
  move_knots(spec, [low, high](double k) {
    if (k == low) return high;
    if (k == high) return low;
    return (DoubleDouble::sum(low, high) - DoubleDouble(k)).hi;
  });
  // The last point first. A periodic curve repeats its first p points at the end of points().
  const auto dim = index_of(curve.dim()), last = index_of(curve.point_count() - 1);
  for (std::size_t i = 0; i < spec.points.size() / dim; ++i) {
    const auto from = curve.points().subspan((last - i) * dim, dim);
    std::copy(from.begin(), from.end(), spec.points.begin() + static_cast<long>(i * dim));
    if (!spec.weights.empty()) spec.weights[i] = curve.weights()[last - i];
  }
  return moved(std::move(spec));
}

Result<NurbsCurve> reparametrize(const NurbsCurve& curve, double u_a, double u_b) {
  const std::string what =
      "curve '" + curve.name() + "': the domain " + number_text(u_a) + ".." + number_text(u_b);
  if (!std::isfinite(u_a) || !std::isfinite(u_b)) {
    return fail(ErrorCode::not_finite, what + " is not finite");
  }
  if (!(u_a < u_b)) return fail(ErrorCode::empty_domain, what + " has no length");
  if (u_a == curve.u_min() && u_b == curve.u_max()) return curve;
  if (std::max(std::abs(u_a), std::abs(u_b)) > kMaxKnot) {
    return fail(ErrorCode::value_out_of_range,
                what + " is not within -" + number_text(kMaxKnot) + ".." + number_text(kMaxKnot));
  }
  CurveSpec spec = curve.spec();
  move_knots(spec, Stretch{curve.u_min(), curve.u_max(), u_a, u_b});
  return moved(std::move(spec));
}

Result<NurbsCurve> bend(const NurbsCurve& curve, double b) {
  const std::string what = "curve '" + curve.name() + "' bent by " + number_text(b);
  if (!(b > 0) || !std::isfinite(b)) {
    return fail(ErrorCode::value_out_of_range, what + ": a bend must be above 0");
  }
  if (curve.is_periodic()) {
    return fail(ErrorCode::unsupported,
                what +
                    ": a periodic curve has no place where the bend could begin; sub_curve() "
                    "cuts it open");
  }
  if (b == 1) return curve;
  double power = 1;  // how far the first and the last weight move apart
  for (int i = 0; i < curve.degree(); ++i) power *= b;
  constexpr double kMostApart = kMaxWeight / kMinWeight;
  if (std::max(power, 1 / power) > kMostApart * kMostApart) {
    return fail(ErrorCode::weight_out_of_range,
                what + ": the weights would be " + number_text(std::max(power, 1 / power)) +
                    " times as far apart, the limits allow " + number_text(kMostApart));
  }
  if (!curve.is_clamped()) {
    auto clamped = sub_curve(curve, curve.u_min(), curve.u_max());
    return clamped ? bend(*clamped, b) : clamped;
  }
  // The blossom of D at x_1..x_p is that of C at g(x_1)..g(x_p) times the denominators of g, so
  // point i keeps its place and its weight takes those of its p knots. With y = g(x) the
  // denominator x + b (1 - x) is b / (1 - y + b y).
  const double low = curve.u_min(), high = curve.u_max();
  const DoubleDouble length = DoubleDouble::difference(high, low);
  const auto bottom = [=](double k) {
    return DoubleDouble::difference(high, k) / length +
           DoubleDouble::difference(k, low) / length * DoubleDouble(b);
  };
  CurveSpec spec = curve.spec();
  const int p = curve.degree();
  spec.weights.clear();
  for (int i = 0; i < curve.point_count(); ++i) {
    DoubleDouble weight = curve.weights()[index_of(i)];
    for (int j = 1; j <= p; ++j) {
      weight = weight * DoubleDouble(b) / bottom(curve.knots()[index_of(i + j)]);
    }
    spec.weights.push_back(weight.hi);
  }
  move_knots(spec, [=](double k) {
    if (k == low || k == high) return k;
    const DoubleDouble along = DoubleDouble::difference(k, low) * DoubleDouble(b) / bottom(k);
    return (DoubleDouble(low) + along).hi;
  });
  if (auto fits = fit_weights(what, spec.weights); !fits) return fits.error();
  return moved(std::move(spec));
}

}  // namespace knotwave::curves
