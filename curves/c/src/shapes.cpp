// SPDX-License-Identifier: MIT
// Curves that have a name, and SVG paths, from C.
#include "knotwave/curves/shapes.h"

#include "knotwave/curves/svg_path.h"

#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;

namespace {

bool is_direction(kw_svg_y y) { return y == KW_SVG_Y_UP || y == KW_SVG_Y_DOWN; }

curves::SvgY direction_of(kw_svg_y y) {
  return y == KW_SVG_Y_DOWN ? curves::SvgY::down : curves::SvgY::up;
}

}  // namespace

kw_status kw_shape_bezier(const double* points, size_t points_count, int32_t dim, kw_curve** out,
                          kw_error** error) {
  return make_curve({array("points", points, points_count)}, out, error,
                    [&] { return curves::bezier(numbers(points, points_count), dim); });
}
kw_status kw_shape_arc(double radius, double start_cycles, double length_cycles, kw_curve** out,
                       kw_error** error) {
  return make_curve({}, out, error,
                    [&] { return curves::arc(radius, start_cycles, length_cycles); });
}
kw_status kw_shape_ellipse(double radius_x, double radius_y, kw_curve** out, kw_error** error) {
  return make_curve({}, out, error, [&] { return curves::ellipse(radius_x, radius_y); });
}
kw_status kw_shape_conic(const double* p0, const double* p1, const double* p2, double w,
                         kw_curve** out, kw_error** error) {
  return make_curve({{"p0", p0}, {"p1", p1}, {"p2", p2}}, out, error, [&] {
    return curves::conic(numbers(p0, 2), numbers(p1, 2), numbers(p2, 2), w);
  });
}
kw_status kw_shape_exponential_decay(double range_db, kw_curve** out, double* max_error_db,
                                     kw_error** error) {
  return make_curve(
      {}, out, error, [&] { return curves::exponential_decay(range_db); },
      [&](const curves::FittedDecay& made) {
        if (max_error_db != nullptr) *max_error_db = made.max_error_db;
      });
}
kw_status kw_shape_css_cubic_bezier(double x1, double y1, double x2, double y2, kw_curve** out,
                                    kw_error** error) {
  return make_curve({}, out, error, [&] { return curves::css_cubic_bezier(x1, y1, x2, y2); });
}
kw_status kw_shape_hermite(const double* times, size_t times_count, const double* values,
                           const double* slopes_in, const double* slopes_out, size_t values_count,
                           int32_t dim, kw_curve** out, kw_error** error) {
  return make_curve(
      {array("times", times, times_count), array("values", values, values_count),
       array("slopes_in", slopes_in, values_count), array("slopes_out", slopes_out, values_count)},
      out, error, [&] {
        return curves::hermite(numbers(times, times_count), numbers(values, values_count),
                               numbers(slopes_in, values_count), numbers(slopes_out, values_count),
                               dim);
      });
}
kw_status kw_shape_catmull_rom(const double* points, size_t points_count, int32_t dim, double alpha,
                               bool closed, kw_curve** out, kw_error** error) {
  return make_curve({array("points", points, points_count)}, out, error, [&] {
    return curves::catmull_rom(numbers(points, points_count), dim, alpha, closed);
  });
}

kw_status kw_curve_set_from_svg_path(const char* d, size_t d_count, kw_svg_y y, kw_curve_set** out,
                                     kw_error** error) {
  return make_curve_set({array("d", d, d_count)}, out, error, [&]() -> Result<curves::CurveSet> {
    if (!is_direction(y)) return unknown_choice("the direction of y", y, 2);
    auto paths = curves::curves_from_svg_path({d, d_count}, direction_of(y));
    if (!paths) return std::move(paths).error();
    return curves::CurveSet{std::move(*paths), {}};
  });
}

kw_status kw_curve_to_svg_path(const kw_curve* curve, double max_error, kw_svg_y y, char** out,
                               double* bound, kw_error** error) {
  if (out != nullptr) *out = nullptr;
  return run({{"curve", curve}, {"out", out}}, error, [&]() -> kw_status {
    if (!is_direction(y)) return report(error, unknown_choice("the direction of y", y, 2));
    return give(curves::svg_path_from_curve(curve->curve, max_error, direction_of(y)), error,
                [&](curves::SvgPath&& path) {
                  *out = new_text(path.d);
                  if (bound != nullptr) *bound = path.max_error;
                });
  });
}
