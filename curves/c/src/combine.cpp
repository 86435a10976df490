// SPDX-License-Identifier: MIT
// Two curves to one, slopes, areas and lengths, from C.
#include "knotwave/curves/combine.h"

#include <algorithm>

#include "knotwave/curves/calculus.h"

#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;

kw_status kw_curve_join(const kw_curve* first, const kw_curve* second, double join_tolerance,
                        kw_curve** out, kw_error** error) {
  return make_curve({{"first", first}, {"second", second}}, out, error,
                    [&] { return curves::join(first->curve, second->curve, join_tolerance); });
}

kw_status kw_curve_make_compatible(const kw_curve* first, const kw_curve* second,
                                   kw_curve** out_first, kw_curve** out_second, kw_error** error) {
  return make_two_curves({{"first", first}, {"second", second}}, out_first, out_second, error,
                         [&]() -> Result<TwoCurves> {
                           auto both = curves::make_compatible(first->curve, second->curve);
                           if (!both) return std::move(both).error();
                           return TwoCurves{std::move(both->first), std::move(both->second)};
                         });
}

kw_status kw_curve_make_all_compatible(const kw_curve* const* curves, size_t curves_count,
                                       kw_curve** out, size_t out_count, kw_error** error) {
  if (out != nullptr) std::fill_n(out, out_count, nullptr);
  return run({array("curves", curves, curves_count), array("out", out, out_count)}, error,
             [&]() -> kw_status {
               if (out_count != curves_count) {
                 return report(error, KW_DIMENSION_MISMATCH, "as many go out as come in");
               }
               const std::string absent = missing_among("curves", curves, curves_count);
               if (!absent.empty()) return report(error, KW_NULL_ARGUMENT, absent);
               const auto all = curves_of(curves, curves_count);
               auto alike = curves::make_compatible(std::span<const curves::NurbsCurve>(all));
               if (!alike) return report(error, std::move(alike).error());
               std::vector<std::unique_ptr<kw_curve>> made;
               for (auto& curve : *alike) {
                 made.push_back(std::make_unique<kw_curve>(kw_curve{std::move(curve)}));
               }
               for (size_t i = 0; i < made.size(); ++i) out[i] = made[i].release();
               return KW_OK;
             });
}

kw_status kw_curve_morph(const kw_curve* first, const kw_curve* second, double amount,
                         kw_curve** out, kw_error** error) {
  return make_curve({{"first", first}, {"second", second}}, out, error,
                    [&] { return curves::morph(first->curve, second->curve, amount); });
}
kw_status kw_curve_sum(const kw_curve* first, const kw_curve* second, kw_curve** out,
                       kw_error** error) {
  return make_curve({{"first", first}, {"second", second}}, out, error,
                    [&] { return curves::sum(first->curve, second->curve); });
}
kw_status kw_curve_product(const kw_curve* first, const kw_curve* second, kw_curve** out,
                           kw_error** error) {
  return make_curve({{"first", first}, {"second", second}}, out, error,
                    [&] { return curves::product(first->curve, second->curve); });
}
kw_status kw_curve_compose(const kw_curve* outer, const kw_curve* inner, kw_curve** out,
                           kw_error** error) {
  return make_curve({{"outer", outer}, {"inner", inner}}, out, error,
                    [&] { return curves::compose(outer->curve, inner->curve); });
}

kw_status kw_curve_hodograph(const kw_curve* curve, kw_curve** out, kw_error** error) {
  return make_curve({{"curve", curve}}, out, error,
                    [&] { return curves::hodograph(curve->curve); });
}
kw_status kw_curve_antiderivative(const kw_curve* curve, double start, kw_curve** out,
                                  kw_error** error) {
  return make_curve({{"curve", curve}}, out, error,
                    [&] { return curves::antiderivative(curve->curve, start); });
}
kw_status kw_curve_integral(const kw_curve* curve, double u_a, double u_b, int32_t coordinate,
                            double* out, kw_error** error) {
  return run({{"curve", curve}, {"out", out}}, error, [&]() -> kw_status {
    if (auto fault = coordinate_fault(curve->curve, coordinate)) return report(error, *fault);
    return give(curves::integral(curve->curve, u_a, u_b, coordinate), error,
                [&](double area) { *out = area; });
  });
}

kw_status kw_curve_arc_length(const kw_curve* curve, double u_a, double u_b, double* out,
                              kw_error** error) {
  return run({{"curve", curve}, {"out", out}}, error, [&] {
    return give(curves::arc_length(curve->curve, u_a, u_b), error,
                [&](double length) { *out = length; });
  });
}
kw_status kw_curve_parameter_at_length(const kw_curve* curve, double length, double* out,
                                       kw_error** error) {
  return run({{"curve", curve}, {"out", out}}, error, [&] {
    return give(curves::parameter_at_length(curve->curve, length), error,
                [&](double u) { *out = u; });
  });
}
