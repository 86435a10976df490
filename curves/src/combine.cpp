// SPDX-License-Identifier: MIT
#include "knotwave/curves/combine.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "knotwave/base/document.h"
#include "knotwave/curves/reparametrize.h"

#include "curve_chain.h"
#include "spline_product.h"

namespace knotwave::curves {
namespace {

using base::number_text;

std::string names_of(const NurbsCurve& first, const NurbsCurve& second) {
  return "curves '" + first.name() + "' and '" + second.name() + "': ";
}

Result<void> check_dims(const NurbsCurve& first, const NurbsCurve& second) {
  if (first.dim() == second.dim()) return {};
  return fail(ErrorCode::dimension_mismatch, names_of(first, second) + std::to_string(first.dim()) +
                                                 " and " + std::to_string(second.dim()) +
                                                 " coordinates");
}

Result<NurbsCurve> clamped(const NurbsCurve& curve) {
  if (curve.is_clamped() && !curve.is_periodic()) return curve;
  return sub_curve(curve, curve.u_min(), curve.u_max());
}

// A periodic curve whose seam has all its knots at the start of the period but one: the same
// points, counted from another one on.
Result<NurbsCurve> with_seam_at_start(const NurbsCurve& curve) {
  CurveSpec spec = curve.spec();
  const auto at_end = std::count(spec.knots.begin(), spec.knots.end(), curve.u_max());
  if (!curve.is_periodic() || at_end == 1) return curve;
  const auto turned = static_cast<long>(at_end) - 1;
  spec.knots.erase(spec.knots.end() - turned, spec.knots.end());
  spec.knots.insert(spec.knots.begin(), static_cast<std::size_t>(turned), curve.u_min());
  std::rotate(spec.points.begin(), spec.points.end() - turned * spec.dim, spec.points.end());
  if (!spec.weights.empty()) {
    std::rotate(spec.weights.begin(), spec.weights.end() - turned, spec.weights.end());
  }
  return NurbsCurve::create(std::move(spec));
}

// Of degree `degree`, clamped unless periodic may stay. Rounded once.
Result<NurbsCurve> raised(const NurbsCurve& curve, int degree, bool periodic) {
  if (curve.is_periodic() && !periodic) {
    auto open = clamped(curve);
    return open ? elevate_degree(*open, degree - curve.degree()) : open;
  }
  if (degree == curve.degree()) return periodic ? with_seam_at_start(curve) : clamped(curve);
  return elevate_degree(curve, degree - curve.degree());
}

bool equal_numbers(std::span<const double> a, std::span<const double> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

bool has_same_basis(const NurbsCurve& first, const NurbsCurve& second) {
  return first.degree() == second.degree() && first.is_periodic() == second.is_periodic() &&
         equal_numbers(first.knots(), second.knots()) &&
         equal_numbers(first.jumps(), second.jumps());
}

// The knots of curves over one domain, each as often as the curve that has it most often.
class CommonKnots {
 public:
  void include(const NurbsCurve& curve) {
    const std::vector<double> written = curve.spec().knots;
    written_.insert(written_.end(), written.begin(), written.end());
    std::sort(written_.begin(), written_.end());
    jumps_.insert(jumps_.end(), curve.jumps().begin(), curve.jumps().end());
    std::sort(jumps_.begin(), jumps_.end());
    jumps_.erase(std::unique(jumps_.begin(), jumps_.end()), jumps_.end());
    std::map<Knot, int> times;
    for (const Knot& knot :
         KnotSequence{curve.knots(), curve.degree(), curve.is_periodic()}.all()) {
      const bool inside = knot.period == 0 && knot.at >= curve.u_min() && knot.at < curve.u_max();
      const bool at_open_end = !curve.is_periodic() && knot.at == curve.u_min();
      if (inside && !at_open_end) ++times[knot];
    }
    for (const auto& [knot, count] : times) times_[knot] = std::max(times_[knot], count);
  }

  // The nearest knot within `slack` of u, or u.
  double snapped(double u, double slack) const {
    const auto above = std::lower_bound(written_.begin(), written_.end(), u);
    double nearest = u, distance = slack;
    if (above != written_.end() && *above - u <= distance) {
      nearest = *above;
      distance = nearest - u;
    }
    if (above != written_.begin() && u - *std::prev(above) <= distance && distance > 0) {
      nearest = *std::prev(above);
    }
    return nearest;
  }

  Result<NurbsCurve> inserted_into(const NurbsCurve& curve) const {
    HomogeneousCurve all(curve);
    for (const auto& [knot, count] : times_) {
      for (int have = all.multiplicity(knot); have < count; ++have) all.insert_and_repeat(knot);
    }
    CurveSpec spec = curve.spec();
    spec.jumps = jumps_;
    all.write_to(spec);
    return NurbsCurve::create(std::move(spec));
  }

 private:
  std::vector<double> written_;
  std::vector<double> jumps_;
  std::map<Knot, int> times_;
};

// `curve` over the domain of `like`; knots that rounding moved beside a known one are moved onto
// it.
Result<NurbsCurve> over_domain_of(const NurbsCurve& like, const CommonKnots& known,
                                  const NurbsCurve& curve) {
  if (curve.u_min() == like.u_min() && curve.u_max() == like.u_max()) return curve;
  auto moved = reparametrize(curve, like.u_min(), like.u_max());
  if (!moved) return moved;
  CurveSpec spec = moved->spec();
  const double slack = 0x1p-50 * std::max(std::abs(like.u_min()), std::abs(like.u_max()));
  for (double& knot : spec.knots) knot = known.snapped(knot, slack);
  for (double& jump : spec.jumps) jump = known.snapped(jump, slack);
  return NurbsCurve::create(std::move(spec));
}

}  // namespace

Result<NurbsCurve> join(const NurbsCurve& first, const NurbsCurve& second, double join_tolerance) {
  if (auto good = check_dims(first, second); !good) return good.error();
  if (!(join_tolerance >= 0)) {
    return fail(ErrorCode::value_out_of_range, names_of(first, second) + "a join tolerance of " +
                                                   number_text(join_tolerance) + " is below 0");
  }
  if (first.is_periodic() || second.is_periodic()) {
    return fail(ErrorCode::unsupported,
                names_of(first, second) + "a periodic curve has no ends; sub_curve() cuts it open");
  }
  const int degree = std::max(first.degree(), second.degree());
  auto left = raised(first, degree, false);
  if (!left) return left;
  auto right = raised(second, degree, false);
  if (!right) return right;
  CurveChain chain(degree, first.dim());
  chain.append(CurvePart(*left), 0);
  CurvePart next(*right);
  const auto shift = [&](double u) {
    return (DoubleDouble::difference(u, second.u_min()) + DoubleDouble(first.u_max())).hi;
  };
  for (double& knot : next.knots) knot = shift(knot);
  for (double& jump : next.jumps) jump = shift(jump);
  chain.append(next, join_tolerance);
  auto result = chain.finish(first.name());
  const bool knots_met = !result && (result.error().code == ErrorCode::empty_domain ||
                                     result.error().code == ErrorCode::parameter_out_of_range);
  if (knots_met) {
    return fail(ErrorCode::knot_multiplicity,
                result.error().message + " (knots that differed are equal after rounding)");
  }
  return result;
}

Result<std::vector<NurbsCurve>> make_compatible(std::span<const NurbsCurve> curves) {
  bool periodic = true, compatible = true;
  int degree = 0;
  for (const NurbsCurve& curve : curves) {
    if (auto good = check_dims(curves.front(), curve); !good) return good.error();
    degree = std::max(degree, curve.degree());
    periodic = periodic && curve.is_periodic();
    compatible = compatible && has_same_basis(curves.front(), curve);
  }
  if (compatible) return std::vector<NurbsCurve>(curves.begin(), curves.end());
  std::vector<NurbsCurve> all;
  CommonKnots common;
  for (const NurbsCurve& curve : curves) {
    const auto high = raised(curve, degree, periodic);
    if (!high) return high.error();
    auto moved = over_domain_of(all.empty() ? *high : all.front(), common, *high);
    if (!moved) return moved.error();
    common.include(*moved);
    all.push_back(std::move(*moved));
  }
  for (NurbsCurve& curve : all) {
    auto fine = common.inserted_into(curve);
    if (!fine) return fine.error();
    curve = std::move(*fine);
  }
  return all;
}

Result<CompatibleCurves> make_compatible(const NurbsCurve& first, const NurbsCurve& second) {
  const NurbsCurve curves[] = {first, second};
  auto both = make_compatible(curves);
  if (!both) return both.error();
  return CompatibleCurves{std::move(both->front()), std::move(both->back())};
}

Result<NurbsCurve> morph(const NurbsCurve& first, const NurbsCurve& second, double amount) {
  if (!(amount >= 0 && amount <= 1)) {
    return fail(ErrorCode::value_out_of_range, names_of(first, second) + "an amount of " +
                                                   number_text(amount) + " is outside 0..1");
  }
  auto both = make_compatible(first, second);
  if (!both) return both.error();
  CurveSpec spec = both->second.spec();
  spec.name = first.name();
  if (amount == 0) return std::move(both->first);
  if (amount == 1) return NurbsCurve::create(std::move(spec));
  HomogeneousCurve mix(both->first);
  const HomogeneousCurve other(both->second);
  for (std::size_t i = 0; i < mix.points.size(); ++i) {
    mix.points[i] =
        blend(mix.points[i], other.points[i], amount, DoubleDouble::difference(1, amount));
  }
  mix.write_to(spec);
  return NurbsCurve::create(std::move(spec));
}

namespace {

Result<void> check_domains(const NurbsCurve& first, const NurbsCurve& second) {
  if (first.u_min() == second.u_min() && first.u_max() == second.u_max()) return {};
  return fail(ErrorCode::parameter_out_of_range,
              names_of(first, second) + "their domains " + number_text(first.u_min()) + ".." +
                  number_text(first.u_max()) + " and " + number_text(second.u_min()) + ".." +
                  number_text(second.u_max()) + " differ; reparametrize() makes them equal");
}

}  // namespace

Result<NurbsCurve> sum(const NurbsCurve& first, const NurbsCurve& second) {
  if (auto good = check_dims(first, second); !good) return good.error();
  if (auto good = check_domains(first, second); !good) return good.error();
  if (first.is_rational() || second.is_rational()) {
    return multiply(first, second, first.dim(),
                    [](const HomogeneousPoint& f, const HomogeneousPoint& g) {
                      HomogeneousPoint point;
                      for (std::size_t c = 0; c < point.x.size(); ++c) {
                        point.x[c] = f.x[c] * g.w + g.x[c] * f.w;
                      }
                      point.w = f.w * g.w;
                      return point;
                    });
  }
  const auto both = make_compatible(first, second);
  if (!both) return both.error();
  CurveSpec spec = both->first.spec();
  const CurveSpec other = both->second.spec();
  for (std::size_t i = 0; i < spec.points.size(); ++i) spec.points[i] += other.points[i];
  spec.weights.clear();
  return NurbsCurve::create(std::move(spec));
}

Result<NurbsCurve> product(const NurbsCurve& first, const NurbsCurve& second) {
  const bool scales = first.dim() == 1 || second.dim() == 1;
  if (auto good = check_dims(first, second); !good && !scales) return good.error();
  if (auto good = check_domains(first, second); !good) return good.error();
  if (first.dim() == 1 && second.dim() > 1) {
    return multiply(first, second, second.dim(),
                    [](const HomogeneousPoint& f, const HomogeneousPoint& g) {
                      HomogeneousPoint point;
                      for (std::size_t c = 0; c < point.x.size(); ++c) point.x[c] = f.x[0] * g.x[c];
                      point.w = f.w * g.w;
                      return point;
                    });
  }
  if (second.dim() == 1) {
    return multiply(first, second, first.dim(),
                    [](const HomogeneousPoint& f, const HomogeneousPoint& g) {
                      HomogeneousPoint point;
                      for (std::size_t c = 0; c < point.x.size(); ++c) point.x[c] = f.x[c] * g.x[0];
                      point.w = f.w * g.w;
                      return point;
                    });
  }
  return multiply(first, second, first.dim(),
                  [](const HomogeneousPoint& f, const HomogeneousPoint& g) {
                    HomogeneousPoint point;
                    for (std::size_t c = 0; c < point.x.size(); ++c) point.x[c] = f.x[c] * g.x[c];
                    point.w = f.w * g.w;
                    return point;
                  });
}

}  // namespace knotwave::curves
