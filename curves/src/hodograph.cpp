// SPDX-License-Identifier: MIT
// hodograph() of calculus.h.
#include <algorithm>
#include <limits>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"
#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/calculus.h"

#include "bernstein.h"
#include "curve_chain.h"
#include "curve_distance.h"
#include "knot_domain.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using base::number_text;

bool has_corner(const NurbsCurve& curve) {
  const auto knots = curve.knots();
  const auto p = index_of(curve.degree());
  for (std::size_t i = 0; i + p <= knots.size(); ++i) {
    const double knot = knots[i];
    const bool inside = knot > curve.u_min() || (curve.is_periodic() && knot == curve.u_min());
    if (inside && knot < curve.u_max() && knot == knots[i + p - 1]) return true;
  }
  return false;
}

// An end of the domain that comes p + 1 times within the knots: points beyond it have no part in
// the curve, and a leg there no width.
bool has_idle_end(const NurbsCurve& curve) {
  const auto knots = curve.knots();
  const auto is_idle = [&](double end, double outermost) {
    return end != outermost && std::ranges::count(knots, end) > curve.degree();
  };
  return is_idle(curve.u_min(), knots.front()) || is_idle(curve.u_max(), knots.back());
}

/// Slope of leg i of the control polygon, over the knots its two points share.
DoubleDouble leg_slope(const NurbsCurve& curve, const KnotSequence& knots, int i, int c) {
  const int p = curve.degree(), dim = curve.dim();
  const DoubleDouble rise = DoubleDouble::difference(curve.points()[index_of((i + 1) * dim + c)],
                                                     curve.points()[index_of(i * dim + c)]);
  const DoubleDouble width = knots.domain().distance(knots[i + 1], knots[i + p + 1]);
  return rise * DoubleDouble(p) / width;
}

// Degree 1: what each span rises by, twice. Equal neighbours need no jump.
Result<NurbsCurve> steps_of(const NurbsCurve& curve) {
  const KnotSequence knots{curve.knots(), 1, false};
  CurveSpec spec = curve.spec();
  const auto inner = curve.knots();
  spec.points.clear();
  spec.weights.clear();
  spec.knots = {curve.u_min()};
  for (int i = 0; i + 1 < curve.point_count(); ++i) {
    if (!(inner[index_of(i + 1)] < inner[index_of(i + 2)])) continue;
    for (int end = 0; end < 2; ++end) {
      for (int c = 0; c < curve.dim(); ++c) {
        spec.points.push_back(leg_slope(curve, knots, i, c).hi);
      }
    }
    spec.knots.insert(spec.knots.end(), {inner[index_of(i + 1)], inner[index_of(i + 2)]});
    if (inner[index_of(i + 2)] < curve.u_max()) spec.jumps.push_back(inner[index_of(i + 2)]);
  }
  spec.knots.push_back(curve.u_max());
  return NurbsCurve::create(std::move(spec));
}

/// Weighted coordinates and weight, each by u. Taken from the control points, as the differences of
/// Bézier points would lose digits on short spans. `curve` has no jumps.
HomogeneousCurve derivative_of(const HomogeneousCurve& curve) {
  const int p = curve.degree;
  HomogeneousCurve slope = curve;
  slope.degree = p - 1;
  slope.knots.assign(curve.knots.begin() + 1, curve.knots.end() - 1);
  slope.points.pop_back();
  for (std::size_t i = 0; i < slope.points.size(); ++i) {
    const HomogeneousPoint &from = curve.points[i], &to = curve.points[i + 1];
    const DoubleDouble width =
        curve.domain.distance(curve.knots[i + 1], curve.knots[i + index_of(p) + 1]);
    const DoubleDouble pace = DoubleDouble(p) / width;
    for (std::size_t c = 0; c < from.x.size(); ++c) {
      slope.points[i].x[c] = (to.x[c] - from.x[c]) * pace;
    }
    slope.points[i].w = (to.w - from.w) * pace;
  }
  return slope;
}

struct Row {
  Bernstein top, weight;
};
/// A coordinate less `origin`, so that an offset costs no digits.
Row row_of(const BezierPiece& piece, int c, DoubleDouble origin) {
  Row row;
  for (const HomogeneousPoint& point : piece.points) {
    row.top.push_back(point.x[index_of(c)] - origin * point.w);
    row.weight.push_back(point.w);
  }
  return row;
}

/// C' = (N' w - N w') / w^2 over one span, the numerator written one degree higher than it has.
CurvePart slope_of(const BezierPiece& piece, const BezierPiece& slope, double u0, double u1,
                   int dim) {
  const Bernstein weight = row_of(piece, 0, 0.0).weight, square = weight * weight;
  CurvePart part;
  part.knots.assign(square.size(), u0);
  part.knots.insert(part.knots.end(), square.size(), u1);
  part.points.resize(square.size());
  for (std::size_t i = 0; i < square.size(); ++i) part.points[i].w = square[i];
  for (int c = 0; c < dim; ++c) {
    const DoubleDouble origin = piece.points.front().x[index_of(c)] / piece.points.front().w;
    const Row at = row_of(piece, c, origin), by_u = row_of(slope, c, origin);
    const Bernstein top = (by_u.top * weight - at.top * by_u.weight) * Bernstein{1.0, 1.0};
    for (std::size_t i = 0; i < square.size(); ++i) part.points[i].x[index_of(c)] = top[i];
  }
  return part;
}

/// `all` is the curve, or its domain alone.
Result<NurbsCurve> rational_hodograph(const NurbsCurve& curve, const HomogeneousCurve& all) {
  const int p = curve.degree();
  if (2 * p > kMaxDegree) {
    return fail(ErrorCode::degree_out_of_range, "the hodograph of curve '" + curve.name() +
                                                    "', rational of degree " + std::to_string(p) +
                                                    ", would have degree " + std::to_string(2 * p) +
                                                    ", the limit is " + std::to_string(kMaxDegree));
  }
  CurveChain chain(2 * p, curve.dim());
  const std::vector<BezierPiece> pieces = bezier_pieces(all);
  const std::vector<BezierPiece> slopes = bezier_pieces(derivative_of(all));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double u0 = all.domain.rounded(pieces[i].left), u1 = all.domain.rounded(pieces[i].right);
    // Fewer than p equal knots: the slope goes on, whatever is left of 106 bits says.
    const bool corner = all.multiplicity(pieces[i].left) >= p;
    chain.append(slope_of(pieces[i], slopes[i], u0, u1, curve.dim()),
                 corner ? 0 : std::numeric_limits<double>::infinity());
  }
  return chain.finish(curve.name());
}

// p times in degree p - 1: a jump.
void declare_jumps(CurveSpec& spec) {
  const auto p = index_of(spec.degree + 1);
  for (std::size_t i = p; i + 2 * p <= spec.knots.size(); ++i) {
    const double knot = spec.knots[i];
    if (knot == spec.knots[i + p - 1]) spec.jumps.push_back(knot);
  }
}

/// The domain alone, its points rounded after they were subtracted: on a short span rounding
/// before that would be most of the slope.
Result<NurbsCurve> hodograph_of_part(const NurbsCurve& curve, const HomogeneousCurve& part) {
  HomogeneousCurve slope = derivative_of(part);
  for (HomogeneousPoint& point : slope.points) point.w = 1.0;
  CurveSpec spec{curve.name(), slope.degree, slope.dim, {}, {}, {}, false, {}};
  slope.round_to(spec);
  declare_jumps(spec);
  return NurbsCurve::create(std::move(spec));
}

}  // namespace

Result<NurbsCurve> hodograph(const NurbsCurve& curve) {
  if (!curve.jumps().empty()) {
    return fail(ErrorCode::unsupported, "curve '" + curve.name() + "' jumps at " +
                                            number_text(curve.jumps()[0]) +
                                            " and has no slope there: split it");
  }
  const int p = curve.degree();
  const bool is_cut = curve.is_periodic() ? !curve.is_rational() && (p == 1 || has_corner(curve))
                                          : has_idle_end(curve) || (!curve.is_rational() &&
                                                                    p == 1 && !curve.is_clamped());
  if (is_cut && p == 1) {
    auto open = sub_curve(curve, curve.u_min(), curve.u_max());
    return open ? hodograph(*open) : open;
  }
  if (is_cut || curve.is_rational()) {
    HomogeneousCurve all(curve);
    if (is_cut) all = all.clamped_part(curve.u_min(), curve.u_max());
    return curve.is_rational() ? rational_hodograph(curve, all) : hodograph_of_part(curve, all);
  }
  if (p == 1) return steps_of(curve);
  const KnotSequence knots{curve.knots(), p, curve.is_periodic()};
  CurveSpec spec = curve.spec();
  spec.degree = p - 1;
  spec.points.clear();
  spec.weights.clear();
  const int count = curve.point_count() - (curve.is_periodic() ? p : 1);
  for (int i = 0; i < count; ++i) {
    for (int c = 0; c < curve.dim(); ++c) {
      spec.points.push_back(leg_slope(curve, knots, i, c).hi);
    }
  }
  if (!curve.is_periodic()) {
    spec.knots.erase(spec.knots.begin());
    spec.knots.pop_back();
    declare_jumps(spec);
  }
  return NurbsCurve::create(std::move(spec));
}

}  // namespace knotwave::curves
