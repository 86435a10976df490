// SPDX-License-Identifier: MIT
#include "knotwave/curves/algorithms.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"

#include "homogeneous.h"
#include "span_basis.h"
#include "spec_checks.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using base::number_text;

Error outside(const NurbsCurve& curve, double u, const std::string& rule) {
  return fail(ErrorCode::parameter_out_of_range,
              "curve '" + curve.name() + "': u = " + number_text(u) + " is " + rule + " " +
                  number_text(curve.u_min()) + ".." + number_text(curve.u_max()));
}

// What stays when points and knots change.
CurveSpec empty_spec_of(const NurbsCurve& curve) {
  CurveSpec spec;
  spec.name = curve.name();
  spec.degree = curve.degree();
  spec.dim = curve.dim();
  return spec;
}

// How often the knot u is there; on the seam of a periodic curve both ends count as one place.
int multiplicity_of(const NurbsCurve& curve, double u) {
  const std::vector<double> knots = curve.spec().knots;
  const auto at_u = std::count(knots.begin(), knots.end(), u);
  if (!curve.is_periodic() || u != curve.u_min()) return static_cast<int>(at_u);
  return static_cast<int>(at_u + std::count(knots.begin(), knots.end(), curve.u_max()) - 1);
}

Error too_often(const NurbsCurve& curve, double u, int times) {
  return fail(ErrorCode::knot_multiplicity,
              "curve '" + curve.name() + "': " + std::to_string(times) +
                  " more knots at u = " + number_text(u) + " beside " +
                  std::to_string(multiplicity_of(curve, u)) + ", degree " +
                  std::to_string(curve.degree()) + " allows " + std::to_string(curve.degree()));
}

Result<void> check_insertion(const NurbsCurve& curve, double u, int times) {
  if (auto good = check_parameter(curve, u); !good) return good;
  if (curve.is_periodic() && u == curve.u_max()) u = curve.u_min();
  const bool at_end = !curve.is_periodic() && (u == curve.u_min() || u == curve.u_max());
  const int multiplicity = multiplicity_of(curve, u);
  if (at_end && multiplicity >= curve.degree()) {
    return outside(curve, u, "a clamped end, knots go inside");
  }
  if (multiplicity + times > curve.degree()) return too_often(curve, u, times);
  return {};
}

// All at once, and rounded once.
Result<NurbsCurve> inserted(const NurbsCurve& curve, const std::vector<double>& knots) {
  if (knots.empty()) return curve;
  HomogeneousCurve all(curve);
  for (double u : knots) {
    if (curve.is_periodic() && u == curve.u_max()) u = curve.u_min();
    all.insert_and_repeat(all.domain.knot(u));
  }
  CurveSpec spec = empty_spec_of(curve);
  spec.periodic = curve.is_periodic();
  spec.jumps.assign(curve.jumps().begin(), curve.jumps().end());
  all.write_to(spec);
  return NurbsCurve::create(std::move(spec));
}

}  // namespace

Result<NurbsCurve> insert_knot(const NurbsCurve& curve, double u, int times) {
  if (times < 0) return too_often(curve, u, times);
  if (auto good = check_insertion(curve, u, times); !good) return good.error();
  return inserted(curve, std::vector<double>(index_of(times), u));
}

Result<NurbsCurve> refine(const NurbsCurve& curve, std::span<const double> knots) {
  std::vector<double> sorted(knots.begin(), knots.end());
  for (double& u : sorted) {
    if (auto good = check_parameter(curve, u); !good) return good.error();
    if (curve.is_periodic() && u == curve.u_max()) u = curve.u_min();
  }
  std::sort(sorted.begin(), sorted.end());
  for (auto run = sorted.begin(); run != sorted.end();) {
    const auto end = std::upper_bound(run, sorted.end(), *run);
    if (auto good = check_insertion(curve, *run, static_cast<int>(end - run)); !good) {
      return good.error();
    }
    run = end;
  }
  return inserted(curve, sorted);
}

Result<NurbsCurve> sub_curve(const NurbsCurve& curve, double u_a, double u_b) {
  for (const double u : {u_a, u_b}) {
    if (auto good = check_parameter(curve, u); !good) return good.error();
  }
  if (!(u_a < u_b)) {
    return fail(ErrorCode::empty_domain, "curve '" + curve.name() +
                                             "': from u = " + number_text(u_a) + " to " +
                                             number_text(u_b) + " there is nothing");
  }
  CurveSpec spec = empty_spec_of(curve);
  for (const double jump : curve.jumps()) {
    if (jump > u_a && jump < u_b) spec.jumps.push_back(jump);
  }
  HomogeneousCurve(curve).clamped_part(u_a, u_b).round_to(spec);
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
