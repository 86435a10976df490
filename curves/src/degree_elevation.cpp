// SPDX-License-Identifier: MIT
// Degree elevation by blossoms: point j of degree p + 1 is the mean of f over its p + 1 knots, each
// left out once; f of p knots is a control point of the curve with those knots inserted. Only
// convex blends, unlike A5.9, so wide and narrow spans side by side cost no digits.
// Source: Ramshaw, Blossoming: A Connect-the-Dots Approach to Splines (1987).
#include <algorithm>

#include "knotwave/base/document.h"

#include "homogeneous.h"
#include "spec_layout.h"

namespace knotwave::curves {
namespace {

std::size_t index_of(int i) { return static_cast<std::size_t>(i); }

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

// `knots` with every different one once more.
template <class K>
std::vector<K> with_one_more(const std::vector<K>& knots) {
  std::vector<K> more;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (i == 0 || knots[i] != knots[i - 1]) more.push_back(knots[i]);
    more.push_back(knots[i]);
  }
  return more;
}

// Points of degree p + 1 over `raised`, the first `count` of them.
std::vector<HomogeneousPoint> raised_points(const HomogeneousCurve& curve,
                                            std::span<const Knot> raised, int count) {
  const int p = curve.degree;
  std::vector<HomogeneousPoint> points;
  for (int j = 0; j < count; ++j) {
    HomogeneousPoint mean;
    mean.w = 0.0;
    for (int left_out = 0; left_out <= p; ++left_out) {
      std::vector<Knot> knots(raised.begin() + j + 1, raised.begin() + j + p + 2);
      knots.erase(knots.begin() + left_out);
      const HomogeneousPoint point = point_with_knots(curve, knots);
      for (std::size_t c = 0; c < mean.x.size(); ++c) mean.x[c] += point.x[c];
      mean.w += point.w;
    }
    for (DoubleDouble& x : mean.x) x = x / static_cast<double>(p + 1);
    mean.w = mean.w / static_cast<double>(p + 1);
    points.push_back(mean);
  }
  return points;
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

CurveSpec raised_spec(const NurbsCurve& curve) {
  CurveSpec spec;
  spec.name = curve.name();
  spec.degree = curve.degree() + 1;
  spec.dim = curve.dim();
  spec.periodic = curve.is_periodic();
  spec.jumps.assign(curve.jumps().begin(), curve.jumps().end());
  return spec;
}

Result<NurbsCurve> elevate_periodic(const NurbsCurve& curve) {
  CurveSpec spec = raised_spec(curve);
  // The seam is one knot: raised where the period begins, and the same again where it ends.
  const std::vector<double> base = written_knots(curve.knots(), curve.degree(), true);
  std::vector<double> raised = with_one_more(base);
  raised.pop_back();
  const int count = static_cast<int>(raised.size()) - 1;
  const std::vector<double> all = expanded_knots(raised, spec.degree, count, true);
  HomogeneousCurve result = unrolled(curve);
  result.points = raised_points(result, KnotSequence{all, spec.degree, true}.all(), count);
  result.round_to(spec);
  spec.knots = raised;
  return NurbsCurve::create(std::move(spec));
}

}  // namespace

Result<NurbsCurve> elevate_degree(const NurbsCurve& curve) {
  if (curve.degree() >= kMaxDegree) {
    return fail(ErrorCode::degree_out_of_range, "curve '" + curve.name() + "': degree " +
                                                    std::to_string(curve.degree() + 1) +
                                                    " is outside 1.." + std::to_string(kMaxDegree));
  }
  if (curve.is_periodic()) return elevate_periodic(curve);
  CurveSpec spec = raised_spec(curve);
  HomogeneousCurve whole(curve);
  whole.points.clear();
  whole.knots.clear();
  std::vector<double> ends(curve.jumps().begin(), curve.jumps().end());
  ends.push_back(curve.u_max());
  std::sort(ends.begin(), ends.end());
  double start = curve.u_min();
  for (const double end : ends) {  // jump to jump: in between, equal knots name one point
    if (!(start < end)) continue;
    const auto part = sub_curve(curve, start, end);
    if (!part) return part.error();
    const HomogeneousCurve smooth(*part);
    const std::vector<Knot> raised = with_one_more(smooth.knots);
    const auto points =
        raised_points(smooth, raised, static_cast<int>(raised.size()) - spec.degree - 1);
    const bool first = whole.knots.empty();
    whole.knots.insert(whole.knots.end(), raised.begin() + (first ? 0 : spec.degree + 1),
                       raised.end());
    whole.points.insert(whole.points.end(), points.begin(), points.end());
    start = end;
  }
  whole.round_to(spec);
  return NurbsCurve::create(std::move(spec));
}

}  // namespace knotwave::curves
