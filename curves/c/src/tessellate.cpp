// SPDX-License-Identifier: MIT
// Curves as few straight steps, from C.
#include "knotwave/curves/tessellate.h"

#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;

namespace {

Result<curves::Sampling> sampling_of(const kw_sampling& from) {
  if (from.reserved != 0) {
    return fail(ErrorCode::value_out_of_range,
                "the sampling's reserved is " + std::to_string(from.reserved) + ", not 0");
  }
  switch (from.method) {
    case KW_SAMPLING_FIXED_STEP:
      return curves::Sampling(curves::FixedStep{from.amount});
    case KW_SAMPLING_MAX_ERROR:
      return curves::Sampling(curves::MaxError{from.amount, from.full_scale});
    case KW_SAMPLING_MAX_STEP:
      return curves::Sampling(curves::MaxStep{from.amount});
    default:
      return unknown_choice("the sampling method", from.method, 3);
  }
}

curves::TessellatorCalls calls_of(const kw_tessellator& from) {
  curves::TessellatorCalls calls;
  if (from.begin != nullptr) calls.begin = [&from](double u) { from.begin(from.user, u); };
  if (from.value != nullptr) {
    calls.value = [&from](double u, std::span<const double> value) {
      from.value(from.user, u, value.data(), value.size());
    };
  }
  if (from.slope != nullptr) {
    calls.slope = [&from](double u, std::span<const double> slope) {
      from.slope(from.user, u, slope.data(), slope.size());
    };
  }
  if (from.end != nullptr) calls.end = [&from](double u) { from.end(from.user, u); };
  return calls;
}

}  // namespace

kw_status kw_curve_tessellate(const kw_curve* curve, const kw_sampling* sampling,
                              const kw_tessellator* calls, int32_t max_values, kw_error** error) {
  return run(
      {{"curve", curve}, {"sampling", sampling}, {"calls", calls}}, error, [&]() -> kw_status {
        if (calls->struct_size != sizeof(kw_tessellator)) {
          return report(error, KW_UNSUPPORTED_VERSION, "begin the calls with KW_TESSELLATOR_INIT");
        }
        const auto policy = sampling_of(*sampling);
        if (!policy) return report(error, policy.error());
        const auto done = tessellate(curve->curve, *policy, calls_of(*calls), max_values);
        return done ? KW_OK : report(error, done.error());
      });
}

kw_status kw_curve_sample_parameters(const kw_curve* curve, const kw_sampling* sampling, double u_a,
                                     double u_b, int32_t max_values, kw_doubles* out,
                                     kw_error** error) {
  if (out != nullptr) *out = {};
  return run({{"curve", curve}, {"sampling", sampling}, {"out", out}}, error, [&]() -> kw_status {
    const auto policy = sampling_of(*sampling);
    if (!policy) return report(error, policy.error());
    return give(sample_parameters(curve->curve, *policy, u_a, u_b, max_values), error,
                [&](const std::vector<curves::Stretch>& stretches) {
                  std::vector<double> all;
                  for (const curves::Stretch& stretch : stretches) {
                    all.insert(all.end(), stretch.begin(), stretch.end());
                  }
                  *out = new_doubles(all);
                });
  });
}
