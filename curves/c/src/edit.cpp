// SPDX-License-Identifier: MIT
// One curve to another, from C.
#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/monotone.h"
#include "knotwave/curves/reduce.h"
#include "knotwave/curves/reparametrize.h"

#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;
using curves::NurbsCurve;
using curves::Regularization;

namespace {

constexpr Regularization kModes[] = {Regularization::none,         Regularization::contain,
                                     Regularization::keep_start,   Regularization::keep_ratio,
                                     Regularization::limit_active, Regularization::limit_opposite};
static_assert(std::size(kModes) == KW_REGULARIZE_LIMIT_OPPOSITE + 1);

bool is_mode(kw_regularization mode) {
  return mode >= KW_REGULARIZE_NONE && mode <= KW_REGULARIZE_LIMIT_OPPOSITE;
}

template <class Work>
kw_status make_reduced(const kw_curve* curve, kw_curve** out, int32_t* removed, double* max_error,
                       kw_error** error, Work&& work) {
  return make_curve({{"curve", curve}}, out, error, work, [&](const curves::ReducedCurve& made) {
    if (removed != nullptr) *removed = made.removed;
    if (max_error != nullptr) *max_error = made.max_error;
  });
}

}  // namespace

kw_status kw_curve_insert_knot(const kw_curve* curve, double u, int32_t times, kw_curve** out,
                               kw_error** error) {
  return make_curve({{"curve", curve}}, out, error,
                    [&] { return curves::insert_knot(curve->curve, u, times); });
}
kw_status kw_curve_refine(const kw_curve* curve, const double* knots, size_t knots_count,
                          kw_curve** out, kw_error** error) {
  return make_curve({{"curve", curve}, array("knots", knots, knots_count)}, out, error,
                    [&]() -> Result<NurbsCurve> {
                      auto fault = count_fault("knots_count", knots_count, kMostKnots);
                      if (fault) return *std::move(fault);
                      return curves::refine(curve->curve, numbers(knots, knots_count));
                    });
}
kw_status kw_curve_elevate_degree(const kw_curve* curve, int32_t times, kw_curve** out,
                                  kw_error** error) {
  return make_curve({{"curve", curve}}, out, error,
                    [&] { return curves::elevate_degree(curve->curve, times); });
}
kw_status kw_curve_part(const kw_curve* curve, double u_a, double u_b, kw_curve** out,
                        kw_error** error) {
  return make_curve({{"curve", curve}}, out, error,
                    [&] { return curves::sub_curve(curve->curve, u_a, u_b); });
}
kw_status kw_curve_split(const kw_curve* curve, double u, kw_curve** out_left, kw_curve** out_right,
                         kw_error** error) {
  return make_two_curves({{"curve", curve}}, out_left, out_right, error,
                         [&]() -> Result<TwoCurves> {
                           auto parts = curves::split(curve->curve, u);
                           if (!parts) return std::move(parts).error();
                           return TwoCurves{std::move(parts->left), std::move(parts->right)};
                         });
}

kw_status kw_curve_remove_knot(const kw_curve* curve, double u, int32_t times, double tolerance,
                               kw_curve** out, int32_t* removed, double* max_error,
                               kw_error** error) {
  return make_reduced(curve, out, removed, max_error, error,
                      [&] { return curves::remove_knot(curve->curve, u, times, tolerance); });
}
kw_status kw_curve_remove_knots(const kw_curve* curve, double tolerance, kw_curve** out,
                                int32_t* removed, double* max_error, kw_error** error) {
  return make_reduced(curve, out, removed, max_error, error,
                      [&] { return curves::remove_knots(curve->curve, tolerance); });
}
kw_status kw_curve_reduce_degree(const kw_curve* curve, double tolerance, kw_curve** out,
                                 double* max_error, kw_error** error) {
  return make_reduced(curve, out, nullptr, max_error, error,
                      [&] { return curves::reduce_degree(curve->curve, tolerance); });
}

kw_status kw_curve_reverse(const kw_curve* curve, kw_curve** out, kw_error** error) {
  return make_curve({{"curve", curve}}, out, error, [&] { return curves::reverse(curve->curve); });
}
kw_status kw_curve_reparametrize(const kw_curve* curve, double u_a, double u_b, kw_curve** out,
                                 kw_error** error) {
  return make_curve({{"curve", curve}}, out, error,
                    [&] { return curves::reparametrize(curve->curve, u_a, u_b); });
}
kw_status kw_curve_bend(const kw_curve* curve, double b, kw_curve** out, kw_error** error) {
  return make_curve({{"curve", curve}}, out, error, [&] { return curves::bend(curve->curve, b); });
}

kw_status kw_curve_regularize(const kw_curve* curve, kw_regularization mode, kw_curve** out,
                              kw_error** error) {
  return make_curve({{"curve", curve}}, out, error, [&]() -> Result<NurbsCurve> {
    if (!is_mode(mode)) return unknown_choice("the mode", mode, std::size(kModes));
    return curves::regularize(curve->curve, kModes[mode]);
  });
}
kw_status kw_regularize_handles(double* a, double* b, kw_regularization mode,
                                bool active_is_start) {
  if (a == nullptr || b == nullptr) return KW_NULL_ARGUMENT;
  if (!is_mode(mode)) return KW_VALUE_OUT_OF_RANGE;
  const auto mended = curves::regularize_handles({*a, *b}, kModes[mode], active_is_start);
  *a = mended.a;
  *b = mended.b;
  return KW_OK;
}
bool kw_is_monotone_cubic(double a, double b) { return curves::is_monotone_cubic(a, b); }
