// SPDX-License-Identifier: MIT
#include "spline_product.h"

#include <algorithm>

#include "knotwave/base/index.h"

#include "curve_chain.h"
#include "spec_layout.h"
#include "weights.h"

namespace knotwave::curves {
namespace {

using base::index_of;

// Point of `curve` that has exactly `knots` [degree] between its first and last knot, once the
// missing ones are inserted. No inner knot of `curve` may be a jump.
HomogeneousPoint point_with_knots(const HomogeneousCurve& curve, std::span<const Knot> knots) {
  const int p = curve.degree;
  const int a = curve.span_at(knots.front(), Side::right);
  const int b = curve.span_at(knots.back(), Side::left);
  const int first = std::min(a, b) - p, last = std::max(a, b);
  HomogeneousCurve part = curve.points_between(first, last);
  for (auto run = knots.begin(); run != knots.end();) {
    const auto end = std::upper_bound(run, knots.end(), *run);
    for (auto have = part.multiplicity(*run); have < end - run; ++have) part.insert(*run);
    run = end;
  }
  const auto shared = std::upper_bound(knots.begin(), knots.end(), knots.front()) - knots.begin();
  const auto after = std::upper_bound(part.knots.begin(), part.knots.end(), knots.front());
  const auto index = static_cast<std::size_t>(after - part.knots.begin() - shared - 1);
  return part.points[std::min(index, part.points.size() - 1)];  // p + 1 equal knots at the end
}

double binomial(int n, int k) {
  double ways = 1;
  for (int i = 0; i < k; ++i) ways = ways * (n - i) / (i + 1);  // whole numbers
  return ways;
}

// One factor: a curve without jumps, or the constant 1.
struct Factor {
  int degree = 0;
  const HomogeneousCurve* curve = nullptr;

  HomogeneousPoint blossom(std::span<const Knot> knots) const {
    if (curve != nullptr) return point_with_knots(*curve, knots);
    HomogeneousPoint one;
    for (DoubleDouble& x : one.x) x = 1.0;
    return one;
  }
  int multiplicity(Knot knot) const { return curve == nullptr ? 0 : curve->multiplicity(knot); }
};

class Product {
 public:
  Product(const Factor& f, const Factor& g, Mix mix) : f_(f), g_(g), mix_(mix) {}

  int degree() const { return f_.degree + g_.degree; }

  // How often an inner knot must be there: as much continuity as the less smooth factor has.
  int multiplicity(Knot knot) const {
    const int in_f = f_.multiplicity(knot), in_g = g_.multiplicity(knot);
    return std::max(in_f > 0 ? in_f + g_.degree : 0, in_g > 0 ? in_g + f_.degree : 0);
  }

  HomogeneousPoint point(std::span<const Knot> knots) {
    runs_.clear();
    for (const Knot& knot : knots) {
      if (runs_.empty() || runs_.back().knot != knot) runs_.push_back({knot, 0});
      ++runs_.back().times;
    }
    sum_ = HomogeneousPoint();
    sum_.w = 0.0;
    deal(0, 1);
    const DoubleDouble all_ways = binomial(degree(), f_.degree);
    for (DoubleDouble& x : sum_.x) x = x / all_ways;
    sum_.w = sum_.w / all_ways;
    return sum_;
  }

 private:
  struct Run {
    Knot knot;
    int times = 0;
  };

  // Every way to deal the runs from `index` on; equal knots are dealt `ways` times the same.
  void deal(std::size_t index, double ways) {
    if (index == runs_.size()) {
      const HomogeneousPoint term = mix_(f_.blossom(to_f_), g_.blossom(to_g_));
      for (std::size_t c = 0; c < sum_.x.size(); ++c) sum_.x[c] += term.x[c] * DoubleDouble(ways);
      sum_.w += term.w * DoubleDouble(ways);
      return;
    }
    int rest = 0;
    for (std::size_t i = index + 1; i < runs_.size(); ++i) rest += runs_[i].times;
    const auto [knot, times] = runs_[index];
    const int wanted = f_.degree - static_cast<int>(to_f_.size());
    for (int share = std::max(0, wanted - rest); share <= std::min(times, wanted); ++share) {
      to_f_.insert(to_f_.end(), index_of(share), knot);
      to_g_.insert(to_g_.end(), index_of(times - share), knot);
      deal(index + 1, ways * binomial(times, share));
      to_f_.resize(to_f_.size() - index_of(share));
      to_g_.resize(to_g_.size() - index_of(times - share));
    }
  }

  Factor f_, g_;
  Mix mix_;
  std::vector<Run> runs_;
  std::vector<Knot> to_f_, to_g_;
  HomogeneousPoint sum_;
};

std::vector<Knot> inner_knots(const Factor& f, const Factor& g, Knot low, Knot high) {
  std::vector<Knot> inner;
  for (const HomogeneousCurve* curve : {f.curve, g.curve}) {
    if (curve == nullptr) continue;
    for (const Knot& knot : curve->knots) {
      if (low < knot && knot < high) inner.push_back(knot);
    }
  }
  std::sort(inner.begin(), inner.end());
  inner.erase(std::unique(inner.begin(), inner.end()), inner.end());
  return inner;
}

// Both without jumps, clamped to [low, high].
CurvePart clamped_product(const Factor& f, const Factor& g, Mix mix, double low, double high) {
  Product product(f, g, mix);
  const auto ends = index_of(product.degree() + 1);
  std::vector<Knot> knots(ends, Knot{0, low});
  for (const Knot& knot : inner_knots(f, g, {0, low}, {0, high})) {
    knots.insert(knots.end(), index_of(product.multiplicity(knot)), knot);
  }
  knots.insert(knots.end(), ends, Knot{0, high});
  CurvePart part;
  for (const Knot& knot : knots) part.knots.push_back(knot.at);
  for (std::size_t i = 0; i + ends < knots.size(); ++i) {
    part.points.push_back(product.point(std::span(knots).subspan(i + 1, ends - 1)));
  }
  return part;
}

// A periodic curve over five periods, the middle one its own: wide enough for every window of knots
// that touches the middle.
HomogeneousCurve unrolled(const NurbsCurve& curve) {
  const int p = curve.degree();
  HomogeneousCurve wide(curve);
  const std::vector<HomogeneousPoint> all = wide.points;
  const int n = static_cast<int>(all.size()) - p;
  wide.knots.clear();
  for (int i = 0; i <= 5 * n; ++i) {
    wide.knots.push_back(wide.domain.knot(curve.knots()[index_of(p + i % n)], i / n - 2));
  }
  wide.points.clear();
  for (int i = 0; i < 5 * n - p; ++i) wide.points.push_back(all[index_of((i + p) % n)]);
  return wide;
}

// The seam is one knot: as often as the product needs it where the period begins, once at its end.
Result<NurbsCurve> periodic_product(const Factor& f, const Factor& g, Mix mix, CurveSpec spec) {
  Product product(f, g, mix);
  const KnotDomain& domain = f.curve->domain;
  const Knot start{0, domain.low};
  spec.knots.assign(index_of(product.multiplicity(start)), domain.low);
  for (const Knot& knot : inner_knots(f, g, start, {1, domain.low})) {
    spec.knots.insert(spec.knots.end(), index_of(product.multiplicity(knot)), knot.at);
  }
  spec.knots.push_back(domain.high);
  const int count = static_cast<int>(spec.knots.size()) - 1;
  const std::vector<double> expanded = expanded_knots(spec.knots, product.degree(), count, true);
  const std::vector<Knot> knots = KnotSequence{expanded, product.degree(), true}.all();
  spec.periodic = true;
  spec.points.resize(index_of(count) * index_of(spec.dim));
  for (std::size_t i = 0; i < index_of(count); ++i) {
    const HomogeneousPoint point =
        product.point(std::span(knots).subspan(i + 1, index_of(product.degree())));
    const auto size = index_of(spec.dim);
    point.project(std::span(spec.points).subspan(i * size, size));
    spec.weights.push_back(point.w.hi);
  }
  if (auto fits = fit_weights("curve '" + spec.name + "'", spec.weights); !fits) {
    return fits.error();
  }
  return NurbsCurve::create(std::move(spec));
}

Result<NurbsCurve> multiply(const NurbsCurve& f, const NurbsCurve* g, int q, int dim, Mix mix) {
  const int degree = f.degree() + q;
  if (degree > kMaxDegree) {
    return fail(ErrorCode::degree_out_of_range, "curve '" + f.name() + "'" +
                                                    (g ? " with curve '" + g->name() + "'" : "") +
                                                    ": degree " + std::to_string(degree) +
                                                    " is outside 1.." + std::to_string(kMaxDegree));
  }
  CurveSpec spec;
  spec.name = f.name();
  spec.degree = degree;
  spec.dim = dim;
  if (f.is_periodic() && (g == nullptr || g->is_periodic())) {
    const HomogeneousCurve wide_f = unrolled(f);
    const HomogeneousCurve wide_g = g ? unrolled(*g) : HomogeneousCurve();
    return periodic_product({f.degree(), &wide_f}, {q, g ? &wide_g : nullptr}, mix, spec);
  }
  // Jump to jump: in between, equal knots name one point.
  std::vector<double> ends(f.jumps().begin(), f.jumps().end());
  if (g != nullptr) ends.insert(ends.end(), g->jumps().begin(), g->jumps().end());
  ends.push_back(f.u_max());
  std::sort(ends.begin(), ends.end());
  const HomogeneousCurve all_f(f);
  const HomogeneousCurve all_g = g ? HomogeneousCurve(*g) : HomogeneousCurve();
  CurveChain chain(degree, dim);
  double start = f.u_min();
  for (const double end : ends) {
    if (!(start < end)) continue;
    const HomogeneousCurve part_f = all_f.clamped_part(start, end);
    const HomogeneousCurve part_g = g ? all_g.clamped_part(start, end) : HomogeneousCurve();
    chain.append(
        clamped_product({f.degree(), &part_f}, {q, g ? &part_g : nullptr}, mix, start, end), 0);
    start = end;
  }
  return chain.finish(f.name());
}

}  // namespace

Result<NurbsCurve> multiply(const NurbsCurve& f, const NurbsCurve& g, int dim, Mix mix) {
  return multiply(f, &g, g.degree(), dim, mix);
}

Result<NurbsCurve> multiply_by_one(const NurbsCurve& f, int q) {
  return multiply(f, nullptr, q, f.dim(),
                  [](const HomogeneousPoint& point, const HomogeneousPoint&) { return point; });
}

}  // namespace knotwave::curves
