// SPDX-License-Identifier: MIT
#include "surface_rows.h"

#include <algorithm>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"
#include "knotwave/curves/combine.h"

namespace knotwave::curves {
namespace {

using base::index_of;

// Where point `along` of row `row` is in a SurfaceSpec with rows of `count_u`.
std::size_t place_of(Direction direction, int row, int along, int count_u) {
  return index_of(direction == Direction::u ? row * count_u + along : along * count_u + row);
}

void append_point(CurveSpec& row, const SurfaceSpec& spec, std::size_t place) {
  const auto size = index_of(spec.dim);
  const auto point = spec.points.begin() + static_cast<long>(place * size);
  row.points.insert(row.points.end(), point, point + spec.dim);
  if (!spec.weights.empty()) row.weights.push_back(spec.weights[place]);
}

}  // namespace

std::vector<NurbsCurve> rows_along(const NurbsSurface& surface, Direction direction) {
  const SurfaceSpec spec = surface.spec();
  const bool along_u = direction == Direction::u;
  const int rows = along_u ? spec.count_v : spec.count_u;
  const int count = along_u ? spec.count_u : spec.count_v;
  std::vector<NurbsCurve> curves;
  for (int r = 0; r < rows; ++r) {
    CurveSpec row;
    row.name = spec.name;
    row.degree = along_u ? spec.degree_u : spec.degree_v;
    row.dim = spec.dim;
    row.knots = along_u ? spec.knots_u : spec.knots_v;
    row.periodic = along_u && spec.periodic_u;
    for (int i = 0; i < count; ++i) {
      append_point(row, spec, place_of(direction, r, i, spec.count_u));
    }
    curves.push_back(std::move(*NurbsCurve::create(std::move(row))));  // as good as the surface
  }
  return curves;
}

Result<NurbsSurface> with_rows(const NurbsSurface& surface, Direction direction,
                               std::span<const NurbsCurve> rows) {
  SurfaceSpec spec = surface.spec();
  const CurveSpec first = rows.front().spec();
  const int count = static_cast<int>(first.points.size()) / spec.dim;
  if (direction == Direction::u) {
    spec.degree_u = first.degree;
    spec.knots_u = first.knots;
    spec.periodic_u = first.periodic;
    spec.count_u = count;
  } else {
    spec.degree_v = first.degree;
    spec.knots_v = first.knots;
    spec.count_v = count;
  }
  const auto size = index_of(spec.dim), total = rows.size() * index_of(count);
  spec.points.assign(total * size, 0.0);
  spec.weights.assign(total, 1.0);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (int i = 0; i < count; ++i) {
      const std::size_t place = place_of(direction, static_cast<int>(r), i, spec.count_u);
      const auto point = rows[r].points().subspan(index_of(i) * size, size);
      std::copy(point.begin(), point.end(), spec.points.begin() + static_cast<long>(place * size));
      spec.weights[place] = rows[r].weights()[index_of(i)];
    }
  }
  return NurbsSurface::create(std::move(spec));
}

Result<NurbsSurface> surface_of_rows(std::string name, std::span<const NurbsCurve> rows,
                                     int degree_v, std::vector<double> knots_v) {
  const CurveSpec first = rows.front().spec();
  SurfaceSpec spec;
  spec.name = std::move(name);
  spec.degree_u = first.degree;
  spec.degree_v = degree_v;
  spec.dim = first.dim;
  spec.count_u = static_cast<int>(first.points.size()) / first.dim;
  spec.count_v = static_cast<int>(rows.size());
  spec.knots_u = first.knots;
  spec.knots_v = std::move(knots_v);
  spec.periodic_u = first.periodic;
  for (const NurbsCurve& row : rows) {
    const auto points = row.points().first(index_of(spec.count_u * spec.dim));
    const auto weights = row.weights().first(index_of(spec.count_u));
    spec.points.insert(spec.points.end(), points.begin(), points.end());
    spec.weights.insert(spec.weights.end(), weights.begin(), weights.end());
  }
  return NurbsSurface::create(std::move(spec));
}

Result<std::vector<NurbsCurve>> compatible_rows(std::span<const NurbsCurve> curves) {
  for (const NurbsCurve& curve : curves) {
    if (curve.jumps().empty()) continue;
    return fail(ErrorCode::unsupported, "curve '" + curve.name() + "': a jump at u = " +
                                            base::number_text(curve.jumps().front()) +
                                            "; surfaces have none, split() cuts there");
  }
  auto rows = make_compatible(curves);
  if (!rows) return rows;
  for (NurbsCurve& row : *rows) {
    CurveSpec spec = row.spec();
    if (row.is_rational() || spec.weights.empty()) continue;
    spec.weights.clear();
    row = std::move(*NurbsCurve::create(std::move(spec)));
  }
  return rows;
}

std::string name_along(const NurbsSurface& surface, Direction direction) {
  return "surface '" + surface.name() + "' along " + (direction == Direction::u ? "u" : "v");
}

Error told_of(const NurbsSurface& surface, Direction direction, Error error) {
  const std::string row = "curve '" + surface.name() + "'";
  if (error.message.starts_with(row)) {
    error.message.replace(0, row.size(), name_along(surface, direction));
  }
  // A row calls its parameter u, whichever direction it runs in.
  const auto parameter = error.message.find(" u = ");
  if (direction == Direction::v && parameter != std::string::npos) {
    error.message[parameter + 1] = 'v';
  }
  return error;
}

}  // namespace knotwave::curves
