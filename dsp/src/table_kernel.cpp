// SPDX-License-Identifier: MIT
#include "table_kernel.h"

#include <cstring>

namespace knotwave::dsp {
namespace {

// The compiler's own 128-bit vectors: gcc and clang lower them to SSE2, NEON or WebAssembly alike.
// Highway, which serves the wider kernels, has no 128-bit target below SSSE3 in the version we use.
using V = float __attribute__((vector_size(16)));
using Int = std::int32_t __attribute__((vector_size(16)));
constexpr std::size_t kLanes = 4;

inline V load(const float* from) {
  V v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
inline void store(V v, float* to) { std::memcpy(to, &v, sizeof v); }

/// Where a phase falls: the first of its taps, and the place between the middle two, -1/2..1/2.
struct Place {
  std::size_t index;
  std::int32_t fraction;  ///< in 2^-24
};
inline Place place(base::Phase phase, int size_log2) {
  const auto fraction = static_cast<std::int32_t>((phase.value << size_log2) >> 40);
  return {static_cast<std::size_t>(phase.value >> (64 - size_log2)), fraction - (1 << 23)};
}

// The six basis functions times 120 at x in [-1/2, 1/2) from the middle between taps 2 and 3. Pairs
// mirror each other: even part + x * odd part. All constants are exact in float.
template <class Value>
struct Weights {
  Value w[WaveTables::kTaps];
};

template <class Value>
inline Value quadratic(Value s, float c0, float c1, float c2) {
  return (s * c2 + c1) * s + c0;
}
template <class Value>
inline Value fifth_power(Value a) {
  const Value square = a * a;
  return square * square * a;
}

template <class Value>
inline Weights<Value> weights_at(Value x) {
  const Value s = x * x;
  const Value even1 = quadratic(s, 7.40625F, 26.25F, -7.5F);
  const Value odd1 = x * quadratic(s, -23.4375F, -7.5F, 5.0F);
  const Value even2 = quadratic(s, 52.5625F, -27.5F, 5.0F);
  const Value odd2 = x * quadratic(s, -48.125F, 35.0F, -10.0F);
  return {{fifth_power(0.5F - x), even1 + odd1, even2 + odd2, even2 - odd2, even1 - odd1,
           fifth_power(0.5F + x)}};
}

/// The sum of taps * weights: pairs from the outside in, a tree that is part of the sound.
template <class Value>
inline Value weighted(const Weights<Value>& w, const Value* t) {
  const Value outer = w.w[0] * t[0] + w.w[5] * t[5];
  const Value middle = w.w[1] * t[1] + w.w[4] * t[4];
  const Value inner = w.w[2] * t[2] + w.w[3] * t[3];
  return (outer + middle) + inner;
}

/// Four samples: `taps(lane, index, low, high)` gives taps 0..3 and 4..7 of each.
template <class Taps>
inline V read_four(const base::Phase* phases, int size_log2, const Taps& taps) {
  std::int32_t fraction[kLanes];
  V low[kLanes], high[kLanes];
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Place at = place(phases[lane], size_log2);
    fraction[lane] = at.fraction;
    taps(lane, at.index, low[lane], high[lane]);
  }
  Int fractions;
  std::memcpy(&fractions, fraction, sizeof fractions);
  const V x = __builtin_convertvector(fractions, V) * 0x1p-24F;
  V t[WaveTables::kTaps];  // transposed: tap k of the four samples
  const V ab = __builtin_shufflevector(low[0], low[1], 0, 4, 1, 5);
  const V cd = __builtin_shufflevector(low[2], low[3], 0, 4, 1, 5);
  t[0] = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
  t[1] = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
  const V ab_up = __builtin_shufflevector(low[0], low[1], 2, 6, 3, 7);
  const V cd_up = __builtin_shufflevector(low[2], low[3], 2, 6, 3, 7);
  t[2] = __builtin_shufflevector(ab_up, cd_up, 0, 1, 4, 5);
  t[3] = __builtin_shufflevector(ab_up, cd_up, 2, 3, 6, 7);
  const V ab_high = __builtin_shufflevector(high[0], high[1], 0, 4, 1, 5);
  const V cd_high = __builtin_shufflevector(high[2], high[3], 0, 4, 1, 5);
  t[4] = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  t[5] = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
  return weighted(weights_at(x), t);
}

}  // namespace

float read_one(TableRow row, const WaveTables::RowBlend& blend, base::Phase phase) KNOTWAVE_RT {
  const Place at = place(phase, row.size_log2);
  const float* first = row.data + row.row_step * static_cast<std::size_t>(blend.first) + at.index;
  float taps[WaveTables::kTaps];
  for (std::size_t k = 0; k < WaveTables::kTaps; ++k) {
    const float* tap = first + k;
    float sum = blend.count == 1 ? *tap : *tap * blend.weight[0];
    for (int r = 1; r < blend.count; ++r) {
      tap += row.row_step;
      sum = sum + *tap * blend.weight[r];
    }
    taps[k] = sum;
  }
  const float x = static_cast<float>(at.fraction) * 0x1p-24F;
  return weighted(weights_at(x), taps);
}

void read_row(TableRow row, std::span<const base::Phase> phases, float* out) KNOTWAVE_RT {
  std::size_t i = 0;
  for (; i + kLanes <= phases.size(); i += kLanes) {
    const V y = read_four(phases.data() + i, row.size_log2,
                          [&](std::size_t, std::size_t index, V& low, V& high) {
                            low = load(row.data + index);
                            high = load(row.data + index + kLanes);
                          });
    store(y, out + i);
  }
  for (; i < phases.size(); ++i) out[i] = read_one(row, {}, phases[i]);
}

void read_blended(TableRow row, const WaveTables::RowBlend* blends, int blend_step,
                  std::span<const base::Phase> phases, float* out) KNOTWAVE_RT {
  const auto step = static_cast<std::size_t>(blend_step);
  std::size_t i = 0;
  for (; i + kLanes <= phases.size(); i += kLanes) {
    const V y = read_four(
        phases.data() + i, row.size_log2,
        [&](std::size_t lane, std::size_t index, V& low, V& high) {
          const WaveTables::RowBlend& blend = blends[(i + lane) * step];
          const float* at = row.data + row.row_step * static_cast<std::size_t>(blend.first) + index;
          float w = blend.weight[0];
          low = load(at) * w;
          high = load(at + kLanes) * w;
          for (int r = 1; r < blend.count; ++r) {
            at += row.row_step;
            w = blend.weight[r];
            low = low + load(at) * w;
            high = high + load(at + kLanes) * w;
          }
        });
    store(y, out + i);
  }
  for (; i < phases.size(); ++i) out[i] = read_one(row, blends[i * step], phases[i]);
}

}  // namespace knotwave::dsp
