// SPDX-License-Identifier: MIT
// A function linear in u has the control points of any B-spline basis at its Greville abscissae
// (linear precision). So the three surfaces of a Coons patch, ruled both ways and bilinear, need
// neither knots nor degrees raised: each control point is the blend of the borders' there.
#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"
#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/surface_shapes.h"

#include "homogeneous_net.h"
#include "surface_rows.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using base::number_text;

// Two borders that face each other, on one clamped knot vector.
struct Borders {
  const char* names[2];
  std::vector<NurbsCurve> curves;
  std::vector<HomogeneousPoint> points[2];  // weighted so that both ends have weight 1
  std::vector<DoubleDouble> at;             // Greville abscissae as fractions of the domain
};

// Ends at weight 1, by a factor common to all.
Result<std::vector<HomogeneousPoint>> with_unit_ends(const NurbsCurve& curve) {
  const double first = curve.weights().front(), last = curve.weights().back();
  if (std::abs(last - first) > 0x1p-50 * first) {
    return fail(ErrorCode::unsupported, "curve '" + curve.name() +
                                            "': a border with different weights at its ends (" +
                                            number_text(first) + " and " + number_text(last) +
                                            "); bend() makes them equal");
  }
  std::vector<HomogeneousPoint> points = HomogeneousCurve(curve).points;
  for (HomogeneousPoint& point : points) {
    for (DoubleDouble& x : point.x) x = x / DoubleDouble(first);
    point.w = point.w / DoubleDouble(first);
  }
  return points;
}

std::vector<DoubleDouble> greville_fractions(const NurbsCurve& curve) {
  const int p = curve.degree();
  const DoubleDouble length = DoubleDouble::difference(curve.u_max(), curve.u_min());
  std::vector<DoubleDouble> fractions;
  for (int i = 0; i < curve.point_count(); ++i) {
    DoubleDouble sum = 0.0;
    for (int k = i + 1; k <= i + p; ++k) {
      sum += DoubleDouble::difference(curve.knots()[index_of(k)], curve.u_min());
    }
    fractions.push_back(sum / (length * DoubleDouble(p)));
  }
  return fractions;
}

Result<Borders> facing(const char* name, const NurbsCurve& first, const char* other_name,
                       const NurbsCurve& second) {
  Borders borders{{name, other_name}, {}, {}, {}};
  for (const NurbsCurve* curve : {&first, &second}) {
    if (curve->is_clamped() && !curve->is_periodic()) {
      borders.curves.push_back(*curve);
      continue;
    }
    auto open = sub_curve(*curve, curve->u_min(), curve->u_max());
    if (!open) return open.error();
    borders.curves.push_back(std::move(*open));
  }
  auto rows = compatible_rows(borders.curves);
  if (!rows) return rows.error();
  borders.curves = std::move(*rows);
  borders.at = greville_fractions(borders.curves.front());
  for (std::size_t i = 0; i < 2; ++i) {
    auto points = with_unit_ends(borders.curves[i]);
    if (!points) return points.error();
    borders.points[i] = std::move(*points);
  }
  return borders;
}

// The corner at the end `high_u` of border `high_v` of `along_u`: that of the border across is
// moved onto it if it is near enough.
Result<void> join_corner(const Borders& along_u, Borders& along_v, bool high_u, bool high_v,
                         double tolerance) {
  const auto& across = along_u.points[high_v ? 1 : 0];
  auto& down = along_v.points[high_u ? 1 : 0];
  const HomogeneousPoint& corner = high_u ? across.back() : across.front();
  HomogeneousPoint& other = high_v ? down.back() : down.front();
  double gap = 0;
  for (std::size_t c = 0; c < corner.x.size(); ++c) {
    gap = std::max(gap, std::abs((corner.x[c] / corner.w - other.x[c] / other.w).hi));
  }
  other = corner;
  if (gap <= tolerance) return {};
  return fail(ErrorCode::not_closed, std::string("coons: ") + along_u.names[high_v ? 1 : 0] +
                                         " and " + along_v.names[high_u ? 1 : 0] + " are " +
                                         number_text(gap) + " apart at the corner (" +
                                         (high_u ? "1" : "0") + ", " + (high_v ? "1" : "0") +
                                         "), the tolerance is " + number_text(tolerance));
}

void add(HomogeneousPoint& sum, const HomogeneousPoint& point, DoubleDouble share) {
  for (std::size_t c = 0; c < sum.x.size(); ++c) sum.x[c] += point.x[c] * share;
  sum.w += point.w * share;
}

// Ruled one way, and the other way, less bilinear.
HomogeneousPoint blended(const Borders& along_u, const Borders& along_v, std::size_t i,
                         std::size_t j) {
  const DoubleDouble s = along_u.at[i], t = along_v.at[j];
  const DoubleDouble shares_u[] = {DoubleDouble(1.0) - s, s};
  const DoubleDouble shares_v[] = {DoubleDouble(1.0) - t, t};
  HomogeneousPoint sum;
  sum.w = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    add(sum, along_u.points[side][i], shares_v[side]);
    add(sum, along_v.points[side][j], shares_u[side]);
    add(sum, along_u.points[side].front(), -(shares_u[0] * shares_v[side]));
    add(sum, along_u.points[side].back(), -(shares_u[1] * shares_v[side]));
  }
  return sum;
}

}  // namespace

Result<NurbsSurface> coons(const NurbsCurve& bottom, const NurbsCurve& top, const NurbsCurve& left,
                           const NurbsCurve& right, double tolerance) {
  if (!(tolerance >= 0)) {
    return fail(ErrorCode::value_out_of_range,
                "coons: a tolerance of " + number_text(tolerance) + " is below 0");
  }
  if (bottom.dim() != left.dim()) {
    return fail(ErrorCode::dimension_mismatch, "coons: bottom has " + std::to_string(bottom.dim()) +
                                                   " coordinates, left has " +
                                                   std::to_string(left.dim()));
  }
  const auto along_u = facing("bottom", bottom, "top", top);
  if (!along_u) return along_u.error();
  auto along_v = facing("left", left, "right", right);
  if (!along_v) return along_v.error();
  for (const bool high_v : {false, true}) {
    for (const bool high_u : {false, true}) {
      auto good = join_corner(*along_u, *along_v, high_u, high_v, tolerance);
      if (!good) return good.error();
    }
  }
  HomogeneousNet net(bottom.name(), bottom.dim());
  net.set_u(along_u->curves[0].degree(), along_u->curves[0].spec().knots);
  net.set_v(along_v->curves[0].degree(), along_v->curves[0].spec().knots);
  for (std::size_t j = 0; j < along_v->at.size(); ++j) {
    for (std::size_t i = 0; i < along_u->at.size(); ++i) {
      net.points.push_back(blended(*along_u, *along_v, i, j));
    }
  }
  return std::move(net).finish();
}

}  // namespace knotwave::curves
