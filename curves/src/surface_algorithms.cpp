// SPDX-License-Identifier: MIT
#include "knotwave/curves/surface_algorithms.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/reduce.h"
#include "knotwave/curves/reparametrize.h"

#include "curve_distance.h"
#include "degree_reduction.h"
#include "knot_removal.h"
#include "surface_rows.h"

namespace knotwave::curves {
namespace {

using base::number_text;

// `edit` of every row, a curve to a Result<NurbsCurve>. All rows have the same knots, so that
// an edit that is decided by knots does the same to each.
template <class Edit>
Result<NurbsSurface> edit_rows(const NurbsSurface& surface, Direction direction, Edit edit) {
  std::vector<NurbsCurve> rows = rows_along(surface, direction);
  for (NurbsCurve& row : rows) {
    auto edited = edit(row);
    if (!edited) return told_of(surface, direction, edited.error());
    row = std::move(*edited);
  }
  return with_rows(surface, direction, rows);
}

// Each row with `times` knots fewer; nothing if one of them has no such curve.
std::vector<NurbsCurve> without_knots(std::span<const NurbsCurve> rows, double at, int times) {
  std::vector<NurbsCurve> after;
  for (const NurbsCurve& row : rows) {
    HomogeneousCurve all(row);
    const KnotRun run = run_of(all, at);
    if (run.spare < times || !remove_knots_of(all, run, times)) return {};
    CurveSpec spec = row.spec();
    all.write_to(spec);
    auto smaller = NurbsCurve::create(std::move(spec));
    if (!smaller) return {};
    after.push_back(std::move(*smaller));
  }
  return after;
}

}  // namespace

Result<NurbsSurface> insert_knot(const NurbsSurface& surface, Direction direction, double at,
                                 int times) {
  return edit_rows(surface, direction,
                   [&](const NurbsCurve& row) { return insert_knot(row, at, times); });
}

Result<NurbsSurface> refine(const NurbsSurface& surface, Direction direction,
                            std::span<const double> knots) {
  return edit_rows(surface, direction, [&](const NurbsCurve& row) { return refine(row, knots); });
}

Result<NurbsSurface> elevate_degree(const NurbsSurface& surface, Direction direction, int times) {
  return edit_rows(surface, direction,
                   [&](const NurbsCurve& row) { return elevate_degree(row, times); });
}

Result<NurbsSurface> sub_surface(const NurbsSurface& surface, Direction direction, double a,
                                 double b) {
  return edit_rows(surface, direction, [&](const NurbsCurve& row) { return sub_curve(row, a, b); });
}

Result<SurfacePair> split(const NurbsSurface& surface, Direction direction, double at) {
  std::vector<NurbsCurve> low = rows_along(surface, direction), high;
  for (NurbsCurve& row : low) {
    auto both = split(row, at);
    if (!both) return told_of(surface, direction, both.error());
    row = std::move(both->left);
    high.push_back(std::move(both->right));
  }
  auto lower = with_rows(surface, direction, low);
  if (!lower) return lower.error();
  auto upper = with_rows(surface, direction, high);
  if (!upper) return upper.error();
  return SurfacePair{std::move(*lower), std::move(*upper)};
}

Result<NurbsSurface> reverse(const NurbsSurface& surface, Direction direction) {
  return edit_rows(surface, direction, [](const NurbsCurve& row) { return reverse(row); });
}

Result<NurbsSurface> reparametrize(const NurbsSurface& surface, Direction direction, double a,
                                   double b) {
  return edit_rows(surface, direction,
                   [&](const NurbsCurve& row) { return reparametrize(row, a, b); });
}

Result<NurbsSurface> transpose(const NurbsSurface& surface) {
  if (surface.is_periodic_u()) {
    return fail(ErrorCode::unsupported,
                "surface '" + surface.name() +
                    "': periodic rows cannot become columns; sub_surface() cuts them open");
  }
  const std::vector<NurbsCurve> columns = rows_along(surface, Direction::v);
  const SurfaceSpec spec = surface.spec();
  return surface_of_rows(spec.name, columns, spec.degree_u, spec.knots_u);
}

Result<ReducedSurface> remove_knot(const NurbsSurface& surface, Direction direction, double at,
                                   int times, double tolerance) {
  const std::vector<NurbsCurve> before = rows_along(surface, direction);
  const auto possible = remove_knot(before.front(), at, std::min(times, 0), tolerance);
  if (!possible) return told_of(surface, direction, possible.error());
  for (int wanted = std::min(times, before.front().degree()); wanted > 0; --wanted) {
    const std::vector<NurbsCurve> after = without_knots(before, at, wanted);
    if (after.empty()) continue;
    const double error = distance_bound(before, after, tolerance);
    if (!(error <= tolerance)) continue;
    auto smaller = with_rows(surface, direction, after);
    if (!smaller) return smaller.error();
    return ReducedSurface{std::move(*smaller), wanted, error};
  }
  return ReducedSurface{surface, 0, 0};
}

Result<ReducedSurface> reduce_degree(const NurbsSurface& surface, Direction direction,
                                     double tolerance) {
  if (!(tolerance >= 0) || !std::isfinite(tolerance)) {
    return fail(ErrorCode::value_out_of_range, name_along(surface, direction) +
                                                   ": a tolerance of " + number_text(tolerance) +
                                                   " is not a number from 0 up");
  }
  const std::vector<NurbsCurve> before = rows_along(surface, direction);
  std::vector<NurbsCurve> after;
  for (const NurbsCurve& row : before) {
    auto reduced = least_squares_reduction(row);
    if (!reduced) {
      return with_tolerance(told_of(surface, direction, reduced.error()), tolerance);
    }
    after.push_back(std::move(*reduced));
  }
  constexpr double kNoLimit = 1e300;
  const double error = distance_bound(before, after, kNoLimit);
  if (!(error <= tolerance)) {
    return fail(ErrorCode::error_bound_missed,
                name_along(surface, direction) + ": at degree " +
                    std::to_string(after.front().degree()) + " it is up to " + number_text(error) +
                    " away, the tolerance is " + number_text(tolerance));
  }
  auto smaller = with_rows(surface, direction, after);
  if (!smaller) return smaller.error();
  return ReducedSurface{std::move(*smaller), 1, error};
}

}  // namespace knotwave::curves
