// SPDX-License-Identifier: MIT
// How a module's kernels follow set_simd_level(). For the files that Highway compiles once for each
// vector unit; everybody else includes simd.h.
#pragma once
#include <atomic>
#include <cstdint>

#include "knotwave/base/rt.h"
#include "knotwave/curves/simd.h"

namespace knotwave::curves {

/// What simd_kernels_in_use() tells of a family of kernels. A static object: it is in the list as
/// long as the program runs.
class SimdFamily {
 public:
  SimdFamily(const SimdFamily&) = delete;
  SimdFamily& operator=(const SimdFamily&) = delete;
  const char* name() const { return name_; }
  /// The vector unit that the kernels at simd_level() were compiled for, as HWY_TARGET.
  std::int64_t unit() const;
  const SimdFamily* next() const { return next_; }

 protected:
  /// Units; `avx2` is 0 where there is none.
  SimdFamily(const char* name, std::int64_t best, std::int64_t avx2, std::int64_t baseline);
  ~SimdFamily() = default;

 private:
  const char* name_;
  std::int64_t best_, avx2_, baseline_;
  const SimdFamily* next_;
};

/// What simd_level() reads. Here, so that choosing kernels takes no call.
extern std::atomic<SimdLevel> simd_level_in_use;

/// Whether this processor has what Highway's AVX2 kernels need.
bool processor_has_avx2();

/// A family's tables of kernels: `Table` holds the functions and, as `unit`, HWY_TARGET. A static
/// object of the file that compiles them:
///
///   HWY_EXPORT(tables);  // const Table* tables(), in HWY_NAMESPACE
///   const SimdKernels<Table> kernels("what they do", HWY_DYNAMIC_DISPATCH(tables),
///                                    HWY_CHOOSE_AVX2(tables), HWY_STATIC_DISPATCH(tables));
template <class Table>
class SimdKernels : private SimdFamily {
 public:
  using Get = const Table* (*)();

  /// `avx2` is null where the build has none.
  SimdKernels(const char* name, Get best, Get avx2, Get baseline)
      : SimdKernels(name, best(), avx2 != nullptr && processor_has_avx2() ? avx2() : nullptr,
                    baseline()) {}

  /// The table of simd_level(). `baseline` is given because this object may be used while it waits
  /// to be made, among other static objects: it is 0 then, and the baseline serves.
  const Table& in_use(Get baseline) const KNOTWAVE_RT {
    const SimdLevel level = simd_level_in_use.load(std::memory_order_relaxed);
    if (level == SimdLevel::best && best_ != nullptr) return *best_;
    if (level == SimdLevel::avx2 && avx2_ != nullptr) return *avx2_;
    return *baseline();
  }

 private:
  SimdKernels(const char* name, const Table* best, const Table* avx2, const Table* baseline)
      : SimdFamily(name, best->unit, avx2 != nullptr ? avx2->unit : 0, baseline->unit),
        best_(best),
        avx2_(avx2) {}

  const Table* best_;
  const Table* avx2_;
};

}  // namespace knotwave::curves
