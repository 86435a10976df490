// SPDX-License-Identifier: MIT
#include "knotwave/curves/algorithms.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"

#include "homogeneous.h"
#include "span_basis.h"

namespace knotwave::curves {
namespace {

using base::number_text;
std::size_t index_of(int i) { return static_cast<std::size_t>(i); }

Error outside(const NurbsCurve& curve, double u, const std::string& rule) {
  return fail(ErrorCode::parameter_out_of_range,
              "curve '" + curve.name() + "': u = " + number_text(u) + " is " + rule + " " +
                  number_text(curve.u_min()) + ".." + number_text(curve.u_max()));
}

bool inside(const NurbsCurve& curve, double u) {
  return u >= curve.u_min() && u <= curve.u_max();  // false for NaN
}

// What stays when points and knots change.
CurveSpec empty_spec_of(const NurbsCurve& curve) {
  CurveSpec spec;
  spec.name = curve.name();
  spec.degree = curve.degree();
  spec.dim = curve.dim();
  return spec;
}

// One period again of an expanded periodic curve of n + p points whose p seam points may be stale:
// `first_true` is the index from which n points are right.
CurveSpec one_period(const HomogeneousCurve& all, int first_true, CurveSpec spec) {
  CurveSpec full = spec;
  all.round_to(full);
  const int p = all.degree, n = static_cast<int>(all.points.size()) - p, dim = all.dim;
  spec.periodic = true;
  spec.points.resize(index_of(n * dim));
  spec.weights.resize(index_of(n));
  for (int i = first_true; i < first_true + n; ++i) {
    for (int c = 0; c < dim; ++c) {
      spec.points[index_of(i % n * dim + c)] = full.points[index_of(i * dim + c)];
    }
    spec.weights[index_of(i % n)] = full.weights[index_of(i)];
  }
  spec.knots.assign(full.knots.begin() + p, full.knots.begin() + p + n + 1);
  return spec;
}

// Knots in a periodic curve: inserted in one period of the expanded curve. The points of one period
// from the first blended one on are right, the p others are their images.
Result<NurbsCurve> insert_periodic(const NurbsCurve& curve, double u, int times) {
  HomogeneousCurve all(curve);
  const int span = all.span_at(all.domain.knot(u), Side::right);
  for (int i = 0; i < times; ++i) all.insert(all.domain.knot(u));
  const int first_true = std::min(span - all.degree + 1, all.degree);
  return NurbsCurve::create(one_period(all, first_true, empty_spec_of(curve)));
}

// How often the knot u is there; on the seam of a periodic curve both ends count as one place.
int multiplicity_of(const NurbsCurve& curve, double u) {
  const std::vector<double> knots = curve.spec().knots;
  const auto at_u = std::count(knots.begin(), knots.end(), u);
  if (!curve.is_periodic() || u != curve.u_min()) return static_cast<int>(at_u);
  return static_cast<int>(at_u + std::count(knots.begin(), knots.end(), curve.u_max()) - 1);
}

}  // namespace

Result<NurbsCurve> insert_knot(const NurbsCurve& curve, double u, int times) {
  if (!inside(curve, u)) return outside(curve, u, "outside");
  if (curve.is_periodic() && u == curve.u_max()) u = curve.u_min();
  const bool at_end = !curve.is_periodic() && (u == curve.u_min() || u == curve.u_max());
  const int multiplicity = multiplicity_of(curve, u);
  if (at_end && multiplicity >= curve.degree()) {
    return outside(curve, u, "a clamped end, knots go inside");
  }
  if (times < 0 || multiplicity + times > curve.degree()) {
    return fail(ErrorCode::knot_multiplicity,
                "curve '" + curve.name() + "': " + std::to_string(times) + " more knots at u = " +
                    number_text(u) + " beside " + std::to_string(multiplicity) + ", degree " +
                    std::to_string(curve.degree()) + " allows " + std::to_string(curve.degree()));
  }
  if (times == 0) return curve;
  if (curve.is_periodic()) return insert_periodic(curve, u, times);
  HomogeneousCurve all(curve);
  for (int i = 0; i < times; ++i) all.insert(all.domain.knot(u));
  CurveSpec spec = empty_spec_of(curve);
  spec.jumps.assign(curve.jumps().begin(), curve.jumps().end());
  all.round_to(spec);
  return NurbsCurve::create(std::move(spec));
}

Result<NurbsCurve> sub_curve(const NurbsCurve& curve, double u_a, double u_b) {
  if (!inside(curve, u_a)) return outside(curve, u_a, "outside");
  if (!inside(curve, u_b)) return outside(curve, u_b, "outside");
  if (!(u_a < u_b)) {
    return fail(ErrorCode::empty_domain, "curve '" + curve.name() +
                                             "': from u = " + number_text(u_a) + " to " +
                                             number_text(u_b) + " there is nothing");
  }
  const int p = curve.degree();
  HomogeneousCurve all(curve);
  const Knot knot_a = all.domain.knot(u_a), knot_b = all.domain.knot(u_b);
  for (const Knot& u : {knot_a, knot_b}) {
    for (int have = all.multiplicity(u); have < p; ++have) all.insert(u);
  }
  // Spans p..: the first one right of u_a and the last one left of u_b hold the end points.
  const int first = all.span_at(knot_a, Side::right);
  const int last = all.span_at(knot_b, Side::left);
  HomogeneousCurve part = all;
  part.points.assign(all.points.begin() + (first - p), all.points.begin() + last + 1);
  part.knots.assign(index_of(p + 1), knot_a);
  part.knots.insert(part.knots.end(), all.knots.begin() + first + 1, all.knots.begin() + last + 1);
  part.knots.insert(part.knots.end(), index_of(p + 1), knot_b);
  CurveSpec spec = empty_spec_of(curve);
  for (const double jump : curve.jumps()) {
    if (jump > u_a && jump < u_b) spec.jumps.push_back(jump);
  }
  part.round_to(spec);
  return NurbsCurve::create(std::move(spec));
}

Result<CurvePair> split(const NurbsCurve& curve, double u) {
  if (!(u > curve.u_min() && u < curve.u_max())) return outside(curve, u, "not strictly inside");
  auto left = sub_curve(curve, curve.u_min(), u);
  if (!left) return left.error();
  auto right = sub_curve(curve, u, curve.u_max());
  if (!right) return right.error();
  return CurvePair{std::move(*left), std::move(*right)};
}

std::vector<BezierSegment> to_bezier(const NurbsCurve& curve) {
  const int p = curve.degree(), dim = curve.dim();
  const HomogeneousCurve all(curve);
  std::vector<BezierSegment> segments;
  std::vector<HomogeneousPoint> points(index_of(p + 1));
  for (int span = p; span < curve.point_count(); ++span) {
    const double u0 = curve.knots()[index_of(span)], u1 = curve.knots()[index_of(span + 1)];
    if (!(u0 < u1)) continue;
    bezier_points(all, span, points);
    BezierSegment segment{u0, u1, p, dim, {}, {}};
    segment.points.resize(index_of((p + 1) * dim));
    for (int r = 0; r <= p; ++r) {
      points[index_of(r)].project(
          std::span(segment.points).subspan(index_of(r * dim), index_of(dim)));
      segment.weights.push_back(points[index_of(r)].w.hi);
    }
    segments.push_back(std::move(segment));
  }
  return segments;
}

void de_casteljau(const BezierSegment& segment, double u, std::span<double> out) noexcept {
  const int p = segment.degree;
  if (!(u > segment.u0)) u = segment.u0;
  if (u > segment.u1) u = segment.u1;
  HomogeneousPoint work[kMaxDegree + 1];
  for (int r = 0; r <= p; ++r) {
    work[r] = HomogeneousPoint(
        std::span(segment.points).subspan(index_of(r * segment.dim), index_of(segment.dim)),
        segment.weights[index_of(r)]);
  }
  const DoubleDouble from_left = DoubleDouble::difference(u, segment.u0);
  const DoubleDouble to_right = DoubleDouble::difference(segment.u1, u);
  for (int level = 1; level <= p; ++level) {
    for (int r = 0; r <= p - level; ++r) {
      work[r] = blend(work[r], work[r + 1], from_left, to_right);
    }
  }
  work[0].project(out.first(index_of(segment.dim)));
}

void de_boor(const NurbsCurve& curve, double u, std::span<double> out) noexcept {
  const int p = curve.degree(), dim = curve.dim();
  const KnotSequence knots{curve.knots(), p, curve.is_periodic()};
  const KnotDomain domain = knots.domain();
  u = domain.place(u, Side::right);
  const Knot here = domain.knot(u);
  const int span = find_span(curve.knots(), p, u, Side::right);
  HomogeneousPoint work[kMaxDegree + 1];
  for (int r = 0; r <= p; ++r) {
    const int i = span - p + r;
    work[r] = HomogeneousPoint(curve.points().subspan(index_of(i * dim), index_of(dim)),
                               curve.weights()[index_of(i)]);
  }
  for (int level = 1; level <= p; ++level) {
    for (int r = 0; r <= p - level; ++r) {
      work[r] = blend(work[r], work[r + 1], domain.distance(knots[span - p + level + r], here),
                      domain.distance(here, knots[span + 1 + r]));
    }
  }
  work[0].project(out.first(index_of(dim)));
}

std::vector<double> greville_abscissae(const NurbsCurve& curve) {
  const int p = curve.degree();
  std::vector<double> abscissae;
  for (int i = 0; i < curve.point_count(); ++i) {
    DoubleDouble sum = 0.0;
    for (int k = 1; k <= p; ++k) sum += curve.knots()[index_of(i + k)];
    abscissae.push_back((sum / static_cast<double>(p)).hi);
  }
  return abscissae;
}

HullRange hull_range(const NurbsCurve& curve, int coordinate) {
  HullRange range{curve.points()[index_of(coordinate)], curve.points()[index_of(coordinate)]};
  for (int i = 1; i < curve.point_count(); ++i) {
    const double x = curve.points()[index_of(i * curve.dim() + coordinate)];
    range.low = std::min(range.low, x);
    range.high = std::max(range.high, x);
  }
  return range;
}

}  // namespace knotwave::curves
