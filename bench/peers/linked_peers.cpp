// SPDX-License-Identifier: MIT
// Compiled for AVX2 with fused multiply-add, which peers may use and we do not.
#include "linked_peers.h"

#include <algorithm>
#include <type_traits>

#if __has_include(<boost/math/interpolators/cardinal_cubic_b_spline.hpp>)
#define HAS_BOOST 1
#include <boost/math/interpolators/cardinal_cubic_b_spline.hpp>
#endif
#if __has_include(<eigen3/unsupported/Eigen/Splines>)
#define HAS_EIGEN 1
#include <eigen3/unsupported/Eigen/Splines>
#endif

#include "peer_curve.h"

namespace peers {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::vector<double> weighted_points(const Curve& curve) {
  std::vector<double> points = curve.points;
  for (std::size_t i = 0; i < points.size(); ++i) points[i] *= curve.weights[i];
  return points;
}

/// De Boor's algorithm as in the books: find the span, copy p + 1 points, blend p times.
template <class Real>
class DeBoor {
 public:
  DeBoor(const Curve& curve, const std::vector<double>& points)
      : knots_(curve.knots.begin(), curve.knots.end()), points_(points.begin(), points.end()) {}

  Real operator()(Real u) const {
    const auto end = knots_.begin() + kPoints;
    const int span =
        static_cast<int>(std::upper_bound(knots_.begin() + 3, end, u) - knots_.begin()) - 1;
    Real d[4];
    for (int j = 0; j <= 3; ++j) d[j] = points_[at(span - 3 + j)];
    for (int level = 1; level <= 3; ++level) {
      for (int j = 3; j >= level; --j) {
        const Real left = knots_[at(span - 3 + j)];
        const Real a = (u - left) / (knots_[at(span + 1 + j - level)] - left);
        d[j] = (1 - a) * d[j - 1] + a * d[j];
      }
    }
    return d[3];
  }

 private:
  std::vector<Real> knots_, points_;
};

#ifdef HAS_EIGEN
template <class Real>
class EigenSpline {
 public:
  using Spline = Eigen::Spline<Real, 1, 3>;
  EigenSpline(const Curve& curve, const std::vector<double>& points) {
    typename Spline::KnotVectorType knots(1, kPoints + 4);
    typename Spline::ControlPointVectorType controls(1, kPoints);
    for (int i = 0; i < kPoints + 4; ++i) knots(i) = static_cast<Real>(curve.knots[at(i)]);
    for (int i = 0; i < kPoints; ++i) controls(i) = static_cast<Real>(points[at(i)]);
    spline_ = Spline(knots, controls);
  }
  Real operator()(Real u) const { return spline_(u)(0); }

 private:
  Spline spline_;
};
#endif

#ifdef HAS_BOOST
/// The same spline: through its values at the knots, with its slopes at both ends.
template <class Real>
class BoostSpline {
 public:
  BoostSpline(const Curve& curve, const std::vector<double>& points)
      : spline_(make(curve, points)) {}
  Real operator()(Real u) const { return spline_(u); }

 private:
  using Spline = boost::math::interpolators::cardinal_cubic_b_spline<Real>;
  static Spline make(const Curve& curve, const std::vector<double>& points) {
    const DeBoor<double> exact(curve, points);
    constexpr int kSpans = kPoints - 3;
    std::vector<Real> values;
    for (int i = 0; i <= kSpans; ++i) {
      values.push_back(static_cast<Real>(i == kSpans ? points.back() : exact(i / double(kSpans))));
    }
    const double first = 3 * kSpans * (points[1] - points[0]);
    const double last = 3 * kSpans * (points[kPoints - 1] - points[kPoints - 2]);
    return Spline(values.data(), values.size(), Real(0), Real(1) / kSpans, static_cast<Real>(first),
                  static_cast<Real>(last));
  }
  Spline spline_;
};
#endif

template <class Real, class Spline, bool Rational>
class PeerOf final : public Peer {
 public:
  explicit PeerOf(const Curve& curve)
      : top_(curve, Rational ? weighted_points(curve) : curve.points),
        bottom_(curve, curve.weights) {}
  void evaluate(std::span<double> out) const override { evaluate_as(out); }
  void evaluate(std::span<float> out) const override { evaluate_as(out); }

 private:
  template <class Out>
  void evaluate_as(std::span<Out> out) const {
    if constexpr (std::is_same_v<Out, Real>) {
      for (int i = 0; i < kGrid; ++i) {
        const Real u = static_cast<Real>(i) * (Real(1) / kGrid);
        out[at(i)] = Rational ? top_(u) / bottom_(u) : top_(u);
      }
    }
  }
  Spline top_, bottom_;
};

template <class Real, template <class> class Spline>
void add(std::vector<NamedPeer>& peers, const std::string& library) {
  const std::string name = library + (sizeof(Real) == 4 ? "/float" : "/double");
  const Curve curve = peer_curve();
  const bool is_float = sizeof(Real) == 4;
  peers.push_back(
      {name + "/cubic", is_float, std::make_unique<PeerOf<Real, Spline<Real>, false>>(curve)});
  peers.push_back({name + "/rational_cubic", is_float,
                   std::make_unique<PeerOf<Real, Spline<Real>, true>>(curve)});
}

}  // namespace

std::vector<NamedPeer> linked_peers() {
  std::vector<NamedPeer> peers;
  add<float, DeBoor>(peers, "de_boor");
  add<double, DeBoor>(peers, "de_boor");
#ifdef HAS_EIGEN
  add<float, EigenSpline>(peers, "eigen_spline");
  add<double, EigenSpline>(peers, "eigen_spline");
#endif
#ifdef HAS_BOOST
  add<float, BoostSpline>(peers, "boost_cardinal_cubic");
  add<double, BoostSpline>(peers, "boost_cardinal_cubic");
#endif
  return peers;
}

}  // namespace peers
