// SPDX-License-Identifier: MIT
// The kernels of table_kernel.h, compiled once for each vector unit (Highway) and chosen at start.
// Samples lie in the lanes; each lane does what read_one() does, in its order, and gives its bits.
// Only Mul, Add and Sub: never MulAdd, whose rounding differs between targets.
#include "table_kernel.h"

#include "knotwave/curves/simd_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "table_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file again for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace knotwave::dsp {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Where a phase falls: the first of its taps, and the place between the middle two in 2^-24.
struct Place {
  std::size_t index;
  std::int32_t fraction;  ///< -2^23 .. 2^23 - 1
};
HWY_INLINE Place place(base::Phase phase, int size_log2) {
  const auto fraction = static_cast<std::int32_t>((phase.value << size_log2) >> 40);
  return {static_cast<std::size_t>(phase.value >> (64 - size_log2)), fraction - (1 << 23)};
}

// The operators of One and Many are no friends written in the class: gcc 12 gives those no target
// attribute, so where nothing is inlined (-O0) they would look for their vectors on the stack, and
// callers would leave them in registers.

/// One sample, in the form the formulas below take.
struct One {
  float v;
  static HWY_INLINE One of(float number) { return {number}; }
};
HWY_INLINE One operator+(One a, One b) { return {a.v + b.v}; }
HWY_INLINE One operator-(One a, One b) { return {a.v - b.v}; }
HWY_INLINE One operator*(One a, One b) { return {a.v * b.v}; }

template <class Number>
HWY_INLINE Number quadratic(Number s, float c0, float c1, float c2) {
  return (s * Number::of(c2) + Number::of(c1)) * s + Number::of(c0);
}

template <class Number>
HWY_INLINE Number fifth_power(Number a) {
  const Number square = a * a;
  return square * square * a;
}

/// The taps t[6] weighted by the quintic basis times 120, at x in [-1/2, 1/2) from the middle
/// between taps 2 and 3. Weights of mirrored taps are even part +- x * odd part; all constants are
/// exact in float. The sum goes by pairs from the outside in: its order is part of the sound.
template <class Number>
HWY_INLINE Number weighted(Number x, const Number* t) {
  const Number s = x * x;
  const Number even1 = quadratic(s, 7.40625F, 26.25F, -7.5F);
  const Number odd1 = x * quadratic(s, -23.4375F, -7.5F, 5.0F);
  const Number even2 = quadratic(s, 52.5625F, -27.5F, 5.0F);
  const Number odd2 = x * quadratic(s, -48.125F, 35.0F, -10.0F);
  const Number half = Number::of(0.5F);
  const Number outer = fifth_power(half - x) * t[0] + fifth_power(half + x) * t[5];
  const Number middle = (even1 + odd1) * t[1] + (even1 - odd1) * t[4];
  const Number inner = (even2 + odd2) * t[2] + (even2 - odd2) * t[3];
  return (outer + middle) + inner;
}

HWY_INLINE float one(const TableRow& row, const WaveTables::RowBlend& blend, base::Phase phase) {
  const Place at = place(phase, row.size_log2);
  const float* first = row.data + row.row_step * static_cast<std::size_t>(blend.first) + at.index;
  One taps[WaveTables::kTaps];
  for (std::size_t k = 0; k < WaveTables::kTaps; ++k) {
    const float* tap = first + k;
    float sum = blend.count == 1 ? *tap : *tap * blend.weight[0];
    for (int r = 1; r < blend.count; ++r) {
      tap += row.row_step;
      sum = sum + *tap * blend.weight[r];
    }
    taps[k].v = sum;
  }
  return weighted(One{static_cast<float>(at.fraction) * 0x1p-24F}, taps).v;
}

#if HWY_TARGET != HWY_SCALAR

using Lanes = hn::CappedTag<float, 8>;
constexpr Lanes kLanes;
constexpr std::size_t kCount = HWY_MAX_BYTES >= 32 ? 8 : 4;

struct Many {
  hn::Vec<Lanes> v;
  static HWY_INLINE Many of(float number) { return {hn::Set(kLanes, number)}; }
};
HWY_INLINE Many operator+(Many a, Many b) { return {hn::Add(a.v, b.v)}; }
HWY_INLINE Many operator-(Many a, Many b) { return {hn::Sub(a.v, b.v)}; }
HWY_INLINE Many operator*(Many a, Many b) { return {hn::Mul(a.v, b.v)}; }

/// a0 b0 a1 b1 (upper: a2 b2 a3 b3) of each 128-bit half.
HWY_INLINE Many zip_lower(Many a, Many b) { return {hn::InterleaveLower(kLanes, a.v, b.v)}; }
HWY_INLINE Many zip_upper(Many a, Many b) { return {hn::InterleaveUpper(kLanes, a.v, b.v)}; }
/// The lower (upper) two of a, then those of b, of each 128-bit half.
HWY_INLINE Many join_lower(Many a, Many b) {
  const hn::RepartitionToWide<hn::RebindToUnsigned<Lanes>> wide;
  return {hn::BitCast(kLanes,
                      hn::InterleaveLower(wide, hn::BitCast(wide, a.v), hn::BitCast(wide, b.v)))};
}
HWY_INLINE Many join_upper(Many a, Many b) {
  const hn::RepartitionToWide<hn::RebindToUnsigned<Lanes>> wide;
  return {hn::BitCast(kLanes,
                      hn::InterleaveUpper(wide, hn::BitCast(wide, a.v), hn::BitCast(wide, b.v)))};
}

/// Where kCount phases fall.
struct Places {
  std::uint64_t index[kCount];
  hn::Vec<hn::RebindToSigned<Lanes>> fraction;
};
HWY_INLINE Places places(const base::Phase* phases, int size_log2) {
  const hn::Repartition<std::uint64_t, Lanes> wide;
  const hn::RebindToUnsigned<Lanes> narrow;
  const auto a = hn::LoadU(wide, &phases[0].value);
  const auto b = hn::LoadU(wide, &phases[kCount / 2].value);
  Places found;
  hn::StoreU(hn::ShiftRightSame(a, 64 - size_log2), wide, found.index);
  hn::StoreU(hn::ShiftRightSame(b, 64 - size_log2), wide, found.index + kCount / 2);
  const auto fraction_a = hn::ShiftRight<40>(hn::ShiftLeftSame(a, size_log2));
  const auto fraction_b = hn::ShiftRight<40>(hn::ShiftLeftSame(b, size_log2));
  const auto fraction =
      hn::ConcatEven(narrow, hn::BitCast(narrow, fraction_b), hn::BitCast(narrow, fraction_a));
  const hn::RebindToSigned<Lanes> with_sign;
  found.fraction = hn::Sub(hn::BitCast(with_sign, fraction), hn::Set(with_sign, 1 << 23));
  return found;
}

/// Taps 0..3 and 4..7 of sample k; with eight lanes those of sample k + 4 in the upper half.
struct Pair {
  Many low, high;
};

/// kCount samples; taps(k), k < 4.
template <class Taps>
HWY_INLINE void many(const Places& at, const Taps& taps_of, float* out) {
  Many low[4], high[4];
  for (std::size_t k = 0; k < 4; ++k) {
    const Pair pair = taps_of(k);
    low[k] = pair.low;
    high[k] = pair.high;
  }
  const Many ab = zip_lower(low[0], low[1]), cd = zip_lower(low[2], low[3]);
  const Many ab_up = zip_upper(low[0], low[1]), cd_up = zip_upper(low[2], low[3]);
  const Many ab_high = zip_lower(high[0], high[1]), cd_high = zip_lower(high[2], high[3]);
  const Many taps[WaveTables::kTaps] = {join_lower(ab, cd),           join_upper(ab, cd),
                                        join_lower(ab_up, cd_up),     join_upper(ab_up, cd_up),
                                        join_lower(ab_high, cd_high), join_upper(ab_high, cd_high)};
  const Many x = Many{hn::ConvertTo(kLanes, at.fraction)} * Many::of(0x1p-24F);
  hn::StoreU(weighted(x, taps).v, kLanes, out);
}

#endif

void row(const TableRow& table, std::span<const base::Phase> phases, float* out) {
  std::size_t i = 0;
#if HWY_TARGET != HWY_SCALAR
  const hn::FixedTag<float, 4> quad;
  for (; i + kCount <= phases.size(); i += kCount) {
    const Places at = places(phases.data() + i, table.size_log2);
    const auto taps = [&](std::size_t k) HWY_ATTR -> Pair {
      const float* first = table.data + at.index[k];
#if HWY_MAX_BYTES >= 32
      const float* other = table.data + at.index[k + 4];
      return {{hn::Combine(kLanes, hn::LoadU(quad, other), hn::LoadU(quad, first))},
              {hn::Combine(kLanes, hn::LoadU(quad, other + 4), hn::LoadU(quad, first + 4))}};
#else
      return {{hn::LoadU(quad, first)}, {hn::LoadU(quad, first + 4)}};
#endif
    };
    many(at, taps, out + i);
  }
#endif
  const WaveTables::RowBlend alone;
  for (; i < phases.size(); ++i) out[i] = one(table, alone, phases[i]);
}

#if HWY_TARGET != HWY_SCALAR

/// kCount taps of `count` rows blended.
HWY_INLINE Many rows_at(const float* from, std::size_t row_step, const float* weight, int count) {
  Many sum = Many{hn::LoadU(kLanes, from)};
  if (count == 1) return sum;
  sum = sum * Many::of(weight[0]);
  for (int r = 1; r < count; ++r) {
    from += row_step;
    sum = sum + Many{hn::LoadU(kLanes, from)} * Many::of(weight[r]);
  }
  return sum;
}

/// Whole groups of kCount samples whose blends all have Count rows; how many samples that was.
template <int Count>
std::size_t blended_groups(const TableRow& table, const WaveTables::RowBlend* blends,
                           std::size_t step, std::span<const base::Phase> phases, float* out) {
  std::size_t i = 0;
  for (; i + kCount <= phases.size(); i += kCount) {
    const Places at = places(phases.data() + i, table.size_log2);
    const auto sum = [&](std::size_t k, std::size_t tap) HWY_ATTR {
      const WaveTables::RowBlend& blend = blends[(i + k) * step];
      const float* first =
          table.data + table.row_step * static_cast<std::size_t>(blend.first) + at.index[k];
      return rows_at(first + tap, table.row_step, blend.weight, Count == 0 ? blend.count : Count);
    };
    const auto taps = [&](std::size_t k) HWY_ATTR -> Pair {
#if HWY_MAX_BYTES >= 32
      const Many first = sum(k, 0), other = sum(k + 4, 0);
      return {{hn::ConcatLowerLower(kLanes, other.v, first.v)},
              {hn::ConcatUpperUpper(kLanes, other.v, first.v)}};
#else
      return {sum(k, 0), sum(k, 4)};
#endif
    };
    many(at, taps, out + i);
  }
  return i;
}

#endif

void blended(const TableRow& table, const WaveTables::RowBlend* blends, std::size_t step,
             std::span<const base::Phase> phases, float* out) {
  std::size_t i = 0;
#if HWY_TARGET != HWY_SCALAR
  switch (blends[0].count) {  // the same at every position of a table
    case 2:
      i = blended_groups<2>(table, blends, step, phases, out);
      break;
    case 4:
      i = blended_groups<4>(table, blends, step, phases, out);
      break;
    default:
      i = blended_groups<0>(table, blends, step, phases, out);
  }
#endif
  for (; i < phases.size(); ++i) out[i] = one(table, blends[i * step], phases[i]);
}

const TableKernels* table_kernels() {
  static constexpr TableKernels kKernels = {HWY_TARGET, row, blended};
  return &kKernels;
}

float one_sample(const TableRow& table, const WaveTables::RowBlend& blend, base::Phase phase) {
  return one(table, blend, phase);
}

}  // namespace HWY_NAMESPACE
}  // namespace knotwave::dsp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace knotwave::dsp {
namespace {
HWY_EXPORT(table_kernels);
HWY_EXPORT(one_sample);
const curves::SimdKernels<TableKernels> kernels_of("wave tables",
                                                   HWY_DYNAMIC_DISPATCH(table_kernels),
                                                   HWY_CHOOSE_AVX2(table_kernels),
                                                   HWY_STATIC_DISPATCH(table_kernels));
}  // namespace

const TableKernels& table_kernels_in_use() KNOTWAVE_RT {
  return kernels_of.in_use(HWY_STATIC_DISPATCH(table_kernels));
}

float read_one(const TableRow& row, const WaveTables::RowBlend& blend,
               base::Phase phase) KNOTWAVE_RT {
  return HWY_STATIC_DISPATCH(one_sample)(row, blend, phase);
}

}  // namespace knotwave::dsp
#endif  // HWY_ONCE
