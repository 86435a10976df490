// SPDX-License-Identifier: MIT
// Trimmed regions from C.
#include "knotwave/curves/trim_region.h"

#include "handles.h"

using namespace knotwave;
using namespace knotwave::c;
using curves::TrimLoop;
using curves::TrimRegion;

struct kw_trim_region {
  TrimRegion region;
};

namespace {

Result<std::vector<TrimLoop>> loops_of(std::vector<curves::NurbsCurve> curves,
                                       std::span<const size_t> sizes) {
  std::vector<TrimLoop> loops;
  size_t first = 0;
  for (const size_t size : sizes) {
    if (size > curves.size() - first) break;
    const auto begin = curves.begin() + static_cast<std::ptrdiff_t>(first);
    loops.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(size));
    first += size;
  }
  if (loops.size() == sizes.size() && first == curves.size()) return loops;
  return fail(ErrorCode::dimension_mismatch,
              "the sizes of the loops do not add up to " + std::to_string(curves.size()));
}

kw_status intervals(const kw_trim_region* region, kw_doubles* out, kw_error** error,
                    std::vector<curves::Interval> (TrimRegion::*kept)(double) const, double at) {
  return run({{"region", region}, {"out", out}}, error, [&]() -> kw_status {
    std::vector<double> rows;
    for (const auto& [low, high] : (region->region.*kept)(at)) {
      rows.insert(rows.end(), {low, high});
    }
    *out = new_doubles(rows);
    return KW_OK;
  });
}

}  // namespace

kw_status kw_trim_region_create(const kw_curve* const* curves, size_t curves_count,
                                const size_t* loop_sizes, size_t loop_count, double tolerance,
                                kw_trim_region** out, kw_error** error) {
  if (out != nullptr) *out = nullptr;
  return run({array("curves", curves, curves_count),
              array("loop_sizes", loop_sizes, loop_count),
              {"out", out}},
             error, [&]() -> kw_status {
               const std::string absent = missing_among("curves", curves, curves_count);
               if (!absent.empty()) return report(error, KW_NULL_ARGUMENT, absent);
               auto loops = loops_of(curves_of(curves, curves_count), {loop_sizes, loop_count});
               if (!loops) return report(error, std::move(loops).error());
               return give(TrimRegion::create(*loops, tolerance), error, [&](TrimRegion&& region) {
                 *out = new kw_trim_region{std::move(region)};
               });
             });
}
void kw_trim_region_free(kw_trim_region* region) { delete region; }

kw_status kw_curve_rectangle(double u_low, double u_high, double v_low, double v_high,
                             kw_curve** out, kw_error** error) {
  return make_curve({}, out, error, [&]() -> Result<curves::NurbsCurve> {
    auto loop = curves::rectangle_loop(u_low, u_high, v_low, v_high);
    if (!loop) return std::move(loop).error();
    return std::move(loop->front());
  });
}

bool kw_trim_region_contains(const kw_trim_region* region, double u, double v) {
  return region != nullptr && region->region.contains(u, v);
}
bool kw_trim_region_is_unbounded(const kw_trim_region* region) {
  return region != nullptr && region->region.is_unbounded();
}
kw_status kw_trim_region_intervals_at_v(const kw_trim_region* region, double v, kw_doubles* out,
                                        kw_error** error) {
  return intervals(region, out, error, &TrimRegion::intervals_at_v, v);
}
kw_status kw_trim_region_intervals_at_u(const kw_trim_region* region, double u, kw_doubles* out,
                                        kw_error** error) {
  return intervals(region, out, error, &TrimRegion::intervals_at_u, u);
}
