// SPDX-License-Identifier: MIT
// What a curve does, asked from C.
#include "knotwave/curves/analysis.h"

#include "knotwave/curves/algorithms.h"

#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;
using curves::NurbsCurve;

namespace {

/// A question about one coordinate; `answer` gets the curve.
template <class Answer>
kw_status ask(std::initializer_list<Needed> needed, const kw_curve* curve, int32_t coordinate,
              kw_error** error, Answer&& answer) noexcept {
  return run(needed, error, [&]() -> kw_status {
    if (curve == nullptr) return report(error, KW_NULL_ARGUMENT, "curve");
    if (auto fault = coordinate_fault(curve->curve, coordinate)) return report(error, *fault);
    answer(curve->curve);
    return KW_OK;
  });
}

/// One whose answer is numbers.
template <class Answer>
kw_status ask_numbers(const kw_curve* curve, int32_t coordinate, kw_doubles* out, kw_error** error,
                      Answer&& answer) noexcept {
  if (out != nullptr) *out = {nullptr, 0};
  return ask({{"out", out}}, curve, coordinate, error,
             [&](const NurbsCurve& asked) { *out = new_doubles(answer(asked)); });
}

template <class T>
void set(T* out, T value) {
  if (out != nullptr) *out = value;
}

}  // namespace

kw_status kw_curve_value_range(const kw_curve* curve, int32_t coordinate, kw_extremum* low,
                               kw_extremum* high, kw_error** error) {
  return ask({}, curve, coordinate, error, [&](const NurbsCurve& asked) {
    const curves::ValueRange range = curves::value_range(asked, coordinate);
    set(low, {range.low.u, range.low.value});
    set(high, {range.high.u, range.high.value});
  });
}

kw_status kw_curve_hull_range(const kw_curve* curve, int32_t coordinate, double* low, double* high,
                              kw_error** error) {
  return ask({}, curve, coordinate, error, [&](const NurbsCurve& asked) {
    const curves::HullRange range = curves::hull_range(asked, coordinate);
    set(low, range.low);
    set(high, range.high);
  });
}

kw_status kw_curve_parameters_at(const kw_curve* curve, double value, int32_t coordinate,
                                 kw_doubles* out, kw_error** error) {
  return ask_numbers(curve, coordinate, out, error, [&](const NurbsCurve& asked) {
    return curves::parameters_at(asked, value, coordinate);
  });
}

kw_status kw_curve_total_variation(const kw_curve* curve, int32_t coordinate, double* out,
                                   kw_error** error) {
  return ask({{"out", out}}, curve, coordinate, error,
             [&](const NurbsCurve& asked) { *out = curves::total_variation(asked, coordinate); });
}

kw_status kw_curve_span_hulls(const kw_curve* curve, int32_t coordinate, kw_doubles* out,
                              kw_error** error) {
  return ask_numbers(curve, coordinate, out, error, [&](const NurbsCurve& asked) {
    std::vector<double> rows;
    for (const curves::SpanHull& hull : curves::span_hulls(asked, coordinate)) {
      rows.insert(rows.end(), {hull.u0, hull.u1, hull.low, hull.high});
    }
    return rows;
  });
}

kw_status kw_curve_breaks(const kw_curve* curve, int32_t max_order, int32_t coordinate,
                          kw_doubles* out, kw_error** error) {
  if (max_order > curves::kMaxBreakOrder) {
    return report(error, fail(ErrorCode::value_out_of_range,
                              "max_order " + std::to_string(max_order) + " is above " +
                                  std::to_string(curves::kMaxBreakOrder)));
  }
  return ask_numbers(curve, coordinate, out, error, [&](const NurbsCurve& asked) {
    std::vector<double> rows;
    for (const curves::Break& found : curves::breaks_of(asked, max_order, coordinate)) {
      rows.insert(rows.end(), {found.u, double(found.order), found.size});
    }
    return rows;
  });
}

kw_status kw_curve_closest_point(const kw_curve* curve, const double* point, size_t point_count,
                                 double* u, double* distance, kw_error** error) {
  return run({{"curve", curve}, array("point", point, point_count)}, error, [&] {
    return give(curves::closest_point(curve->curve, numbers(point, point_count)), error,
                [&](const curves::ClosestPoint& nearest) {
                  set(u, nearest.u);
                  set(distance, nearest.distance);
                });
  });
}

kw_status kw_curve_is_non_decreasing(const kw_curve* curve, int32_t coordinate, bool* out,
                                     kw_error** error) {
  return ask({{"out", out}}, curve, coordinate, error,
             [&](const NurbsCurve& asked) { *out = curves::is_non_decreasing(asked, coordinate); });
}

kw_status kw_curve_greville_abscissae(const kw_curve* curve, kw_doubles* out, kw_error** error) {
  return ask_numbers(curve, 0, out, error,
                     [](const NurbsCurve& asked) { return curves::greville_abscissae(asked); });
}
