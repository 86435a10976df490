// SPDX-License-Identifier: MIT
#include "knotwave/curves/surface_shapes.h"

#include "knotwave/base/index.h"
#include "knotwave/curves/algorithms.h"

#include "circle.h"
#include "homogeneous_net.h"
#include "surface_rows.h"

namespace knotwave::curves {
namespace {

using base::index_of;

}  // namespace

Result<NurbsSurface> ruled(const NurbsCurve& first, const NurbsCurve& second) {
  const NurbsCurve curves[] = {first, second};
  const auto rows = compatible_rows(curves);
  if (!rows) return rows.error();
  return surface_of_rows(first.name(), *rows, 1, {0, 0, 1, 1});
}

Result<NurbsSurface> revolved(const NurbsCurve& profile, double length_cycles) {
  if (profile.dim() != 2) {
    return fail(ErrorCode::dimension_mismatch, "curve '" + profile.name() +
                                                   "': a profile has 2 coordinates, found " +
                                                   std::to_string(profile.dim()));
  }
  const auto rows = compatible_rows(std::span(&profile, 1));
  if (!rows) return rows.error();
  auto open = rows->front().is_periodic() ? sub_curve(profile, profile.u_min(), profile.u_max())
                                          : Result<NurbsCurve>(rows->front());
  if (!open) return open.error();
  const auto around = unit_arc("curve '" + profile.name() + "' turned", 0, length_cycles);
  if (!around) return around.error();
  HomogeneousNet net(profile.name(), 3);
  net.set_u(2, around->knots);
  net.set_v(open->degree(), {open->knots().begin(), open->knots().end()});
  for (int j = 0; j < open->point_count(); ++j) {
    const DoubleDouble x = open->points()[index_of(2 * j)], y = open->points()[index_of(2 * j + 1)];
    for (const UnitArc::Point& at : around->points) {
      const DoubleDouble weight = at.weight * DoubleDouble(open->weights()[index_of(j)]);
      HomogeneousPoint point;
      point.x[0] = x * at.x * weight;
      point.x[1] = x * at.y * weight;
      point.x[2] = y * weight;
      point.w = weight;
      net.points.push_back(point);
    }
  }
  return std::move(net).finish();
}

Result<NurbsSurface> bilinear(std::span<const double> corners, int dim) {
  SurfaceSpec spec;
  spec.name = "bilinear";
  spec.degree_u = spec.degree_v = 1;
  spec.count_u = spec.count_v = 2;
  spec.dim = dim;
  spec.points.assign(corners.begin(), corners.end());
  return NurbsSurface::create(std::move(spec));
}

}  // namespace knotwave::curves
