// SPDX-License-Identifier: MIT
// Curves from data, from C.
#include "knotwave/curves/fit.h"

#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;
using curves::Spacing;

namespace {

constexpr Spacing kSpacings[] = {Spacing::uniform, Spacing::chord, Spacing::centripetal};
static_assert(std::size(kSpacings) == KW_SPACING_CENTRIPETAL + 1);

template <class Work>
kw_status make_fitted(std::initializer_list<Needed> needed, kw_curve** out, double* max_error,
                      kw_error** error, Work&& work) {
  return make_curve(needed, out, error, work, [&](const curves::FittedCurve& made) {
    if (max_error != nullptr) *max_error = made.max_error;
  });
}

}  // namespace

kw_status kw_curve_interpolate(const double* points, size_t points_count, int32_t dim,
                               int32_t degree, kw_spacing spacing, kw_curve** out,
                               kw_error** error) {
  return make_curve(
      {array("points", points, points_count)}, out, error, [&]() -> Result<curves::NurbsCurve> {
        if (spacing < KW_SPACING_UNIFORM || spacing > KW_SPACING_CENTRIPETAL) {
          return unknown_choice("the spacing", spacing, std::size(kSpacings));
        }
        return curves::interpolate(numbers(points, points_count), dim, degree, kSpacings[spacing]);
      });
}

kw_status kw_curve_interpolate_at(const double* parameters, size_t parameters_count,
                                  const double* points, size_t points_count, int32_t dim,
                                  int32_t degree, kw_curve** out, kw_error** error) {
  return make_curve(
      {array("parameters", parameters, parameters_count), array("points", points, points_count)},
      out, error, [&] {
        return curves::interpolate_at(numbers(parameters, parameters_count),
                                      numbers(points, points_count), dim, degree);
      });
}

kw_status kw_curve_approximate(const double* parameters, size_t parameters_count,
                               const double* values, size_t values_count, int32_t dim,
                               int32_t degree, int32_t point_count, kw_curve** out,
                               double* max_error, kw_error** error) {
  return make_fitted(
      {array("parameters", parameters, parameters_count), array("values", values, values_count)},
      out, max_error, error, [&] {
        return curves::approximate(numbers(parameters, parameters_count),
                                   numbers(values, values_count), dim, degree, point_count);
      });
}

kw_status kw_curve_reduce_data(const double* times, size_t times_count, const double* values,
                               size_t values_count, int32_t dim, double tolerance, int32_t degree,
                               kw_curve** out, double* max_error, kw_error** error) {
  return make_fitted({array("times", times, times_count), array("values", values, values_count)},
                     out, max_error, error, [&] {
                       return curves::reduce_data(numbers(times, times_count),
                                                  numbers(values, values_count), tolerance, degree,
                                                  dim);
                     });
}
