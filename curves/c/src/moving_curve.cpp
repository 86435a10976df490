// SPDX-License-Identifier: MIT
// Curves whose points move, from C.
#include "knotwave/curves/moving_curve.h"

#include <algorithm>

#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;

struct kw_moving_curve {
  curves::MovingCurve curve;
};

kw_status kw_moving_curve_create(const kw_curve* curve, kw_moving_curve** out, kw_error** error) {
  if (out != nullptr) *out = nullptr;
  return run({{"curve", curve}, {"out", out}}, error, [&]() -> kw_status {
    return give(curves::MovingCurve::create(curve->curve), error,
                [&](curves::MovingCurve&& made) { *out = new kw_moving_curve{std::move(made)}; });
  });
}
void kw_moving_curve_free(kw_moving_curve* curve) { delete curve; }

int32_t kw_moving_curve_degree(const kw_moving_curve* curve) {
  return curve ? curve->curve.degree() : 0;
}
size_t kw_moving_curve_point_count(const kw_moving_curve* curve) {
  return curve ? index_of(curve->curve.point_count()) : 0;
}

double kw_moving_curve_at(const kw_moving_curve* curve, double time, const double* points,
                          size_t points_count) {
  if (curve == nullptr || points == nullptr) return 0;
  if (points_count != 2 * kw_moving_curve_point_count(curve)) return 0;
  return curve->curve.at(time, {points, points_count});
}

kw_status kw_moving_curve_render(const kw_moving_curve* curve, const double* times,
                                 size_t times_count, const double* const* rows, size_t rows_count,
                                 double* out, size_t out_count) {
  if (out == nullptr && out_count > 0) return KW_NULL_ARGUMENT;
  const auto silence = [&](kw_status status) {
    std::fill_n(out, out_count, 0.0);
    return status;
  };
  if (curve == nullptr || (times == nullptr && times_count > 0)) return silence(KW_NULL_ARGUMENT);
  const size_t wanted = 2 * kw_moving_curve_point_count(curve);
  if (times_count != out_count || rows_count != wanted) return silence(KW_DIMENSION_MISMATCH);
  if (rows == nullptr || std::find(rows, rows + rows_count, nullptr) != rows + rows_count) {
    return silence(KW_NULL_ARGUMENT);
  }
  curve->curve.render({times, times_count}, {rows, rows_count}, {out, out_count});
  return KW_OK;
}
