// SPDX-License-Identifier: MIT
// Skinning: all columns of weighted control points are interpolated at once, with one matrix.
#include <cmath>

#include "knotwave/base/index.h"
#include "knotwave/curves/surface_shapes.h"

#include "chords.h"
#include "homogeneous_net.h"
#include "spline_fit.h"
#include "surface_rows.h"

namespace knotwave::curves {
namespace {

using base::index_of;

// Square roots of the distances from row to row, of point `index` of each.
std::vector<double> column_steps(const std::vector<NurbsCurve>& rows, int index) {
  const int dim = rows.front().dim();
  std::vector<double> column;
  for (const NurbsCurve& row : rows) {
    const auto point = row.points().subspan(index_of(index * dim), index_of(dim));
    column.insert(column.end(), point.begin(), point.end());
  }
  std::vector<double> steps = chords(column, dim);
  for (double& step : steps) step = std::sqrt(step);
  return steps;
}

// The mean of what each column that moves would have for itself (10.8).
Result<std::vector<double>> centripetal_positions(const std::vector<NurbsCurve>& rows) {
  std::vector<double> steps(rows.size(), 0.0);
  for (int i = 0; i < rows.front().point_count(); ++i) {
    const std::vector<double> column = column_steps(rows, i);
    double total = 0;
    for (const double step : column) total += step;
    for (std::size_t k = 1; k < rows.size() && total > 0; ++k) steps[k] += column[k - 1] / total;
  }
  std::vector<double> positions{0};
  for (std::size_t k = 1; k < rows.size(); ++k) {
    if (!(steps[k] > 0)) {
      return fail(ErrorCode::knots_decrease, "lofting: rows " + std::to_string(k - 1) + " and " +
                                                 std::to_string(k) +
                                                 " are the same; only given positions have a "
                                                 "step between them");
    }
    positions.push_back(positions.back() + steps[k]);
  }
  const double total = positions.back();
  for (double& position : positions) position /= total;
  return positions;
}

Result<void> check_degree(int degree, std::size_t rows) {
  if (degree < 1 || degree > kMaxDegree) {
    return fail(ErrorCode::degree_out_of_range, "lofting: degree " + std::to_string(degree) +
                                                    " is outside 1.." + std::to_string(kMaxDegree));
  }
  if (rows > index_of(degree)) return {};
  return fail(ErrorCode::too_few_points, "lofting: degree " + std::to_string(degree) + " needs " +
                                             std::to_string(degree + 1) + " rows, found " +
                                             std::to_string(rows));
}

Result<std::vector<double>> checked_positions(const std::vector<NurbsCurve>& rows,
                                              std::span<const double> given) {
  if (given.empty()) return centripetal_positions(rows);
  if (given.size() != rows.size()) {
    return fail(ErrorCode::dimension_mismatch, "lofting: " + std::to_string(given.size()) +
                                                   " positions for " + std::to_string(rows.size()) +
                                                   " rows");
  }
  if (auto good = check_samples("lofting", {given, given}, 1); !good) return good.error();
  return std::vector<double>(given.begin(), given.end());
}

}  // namespace

Result<NurbsSurface> lofted(std::span<const NurbsCurve> rows, int degree_v,
                            std::span<const double> positions) {
  if (auto good = check_degree(degree_v, rows.size()); !good) return good.error();
  const auto all = compatible_rows(rows);
  if (!all) return all.error();
  const auto at = checked_positions(*all, positions);
  if (!at) return at.error();
  const NurbsCurve& first = all->front();
  const CurveSpec written = first.spec();
  const int count = static_cast<int>(written.points.size()) / first.dim(), dim = first.dim();
  if (all->size() * index_of(count) > index_of(kMaxPoints)) {
    return fail(ErrorCode::too_many_points,
                "lofting: " + std::to_string(all->size()) + " rows of " + std::to_string(count) +
                    " points, at most " + std::to_string(kMaxPoints) + " points are possible");
  }
  const int columns = count * (dim + 1);
  std::vector<DoubleDouble> values;  // [rows*columns]: of each point the coordinates, the weight
  for (const NurbsCurve& row : *all) {
    const HomogeneousCurve weighted(row);
    for (int i = 0; i < count; ++i) {
      const HomogeneousPoint& point = weighted.points[index_of(i)];
      values.insert(values.end(), point.x.begin(), point.x.begin() + dim);
      values.push_back(point.w);
    }
  }
  const Spline frame{degree_v, dim, averaged_knots(*at, degree_v), {}};
  if (!solve_interpolation(frame, *at, values, columns)) {
    return fail(ErrorCode::knots_decrease,
                "lofting: the positions are too close for knots between them");
  }
  HomogeneousNet net(first.name(), dim);
  net.set_u(first.degree(), written.knots, written.periodic);
  net.set_v(degree_v, frame.knots);
  for (auto value = values.begin(); value != values.end();) {
    HomogeneousPoint& point = net.points.emplace_back();
    for (int c = 0; c < dim; ++c) point.x[index_of(c)] = *value++;
    point.w = *value++;
  }
  return std::move(net).finish();
}

}  // namespace knotwave::curves
