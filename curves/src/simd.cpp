// SPDX-License-Identifier: MIT
// The level that all kernels follow, and the list of their families.
#include "knotwave/curves/simd.h"

#include <algorithm>
#include <atomic>

#include <hwy/highway.h>

#include "knotwave/curves/simd_kernels.h"

namespace knotwave::curves {
namespace {

const SimdFamily* first_family = nullptr;  // families are made one by one, as static objects

constexpr bool kBuildHasAvx2 = (HWY_TARGETS & HWY_AVX2) != 0;

/// The best unit of a set: Highway gives it the lowest bit.
const char* best_of(std::int64_t units) { return hwy::TargetName(units & -units); }

std::int64_t usable_units() {
  const std::int64_t units = hwy::SupportedTargets() & HWY_TARGETS;
  return units != 0 ? units : HWY_STATIC_TARGET;
}

}  // namespace

std::atomic<SimdLevel> simd_level_in_use = SimdLevel::best;

SimdFamily::SimdFamily(const char* name, std::int64_t best, std::int64_t avx2,
                       std::int64_t baseline)
    : name_(name), best_(best), avx2_(avx2), baseline_(baseline), next_(first_family) {
  first_family = this;
}

std::int64_t SimdFamily::unit() const {
  const SimdLevel level = simd_level();
  return level == SimdLevel::best ? best_ : level == SimdLevel::avx2 ? avx2_ : baseline_;
}

bool processor_has_avx2() { return (hwy::SupportedTargets() & HWY_AVX2) != 0; }

const char* to_string(SimdLevel level) noexcept {
  return level == SimdLevel::best ? "best" : level == SimdLevel::avx2 ? "avx2" : "baseline";
}

Result<void> set_simd_level(SimdLevel level) {
  if (level == SimdLevel::avx2 && !kBuildHasAvx2) {
    return fail(ErrorCode::unsupported, "this build has no AVX2 kernels: its baseline is " +
                                            std::string(hwy::TargetName(HWY_STATIC_TARGET)) +
                                            "; best and baseline work");
  }
  if (level == SimdLevel::avx2 && !processor_has_avx2()) {
    return fail(ErrorCode::unsupported, "this processor has no AVX2: its best vector unit is " +
                                            std::string(best_of(usable_units())) +
                                            "; best and baseline work");
  }
  simd_level_in_use = level;
  return {};
}

SimdLevel simd_level() KNOTWAVE_RT { return simd_level_in_use.load(std::memory_order_relaxed); }

std::vector<SimdLevel> simd_levels() {
  if (!kBuildHasAvx2 || !processor_has_avx2()) return {SimdLevel::best, SimdLevel::baseline};
  return {SimdLevel::best, SimdLevel::avx2, SimdLevel::baseline};
}

const char* simd_level_name() {
  const SimdLevel level = simd_level();
  if (level == SimdLevel::best) return best_of(usable_units());
  return hwy::TargetName(level == SimdLevel::avx2 ? HWY_AVX2 : HWY_STATIC_TARGET);
}

std::vector<SimdKernelUse> simd_kernels_in_use() {
  std::vector<SimdKernelUse> all;
  for (const SimdFamily* family = first_family; family != nullptr; family = family->next()) {
    all.push_back({family->name(), hwy::TargetName(family->unit())});
  }
  std::ranges::sort(all, {}, &SimdKernelUse::family);
  return all;
}

}  // namespace knotwave::curves
