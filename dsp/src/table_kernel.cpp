// SPDX-License-Identifier: MIT
#include "table_kernel.h"

#include <hwy/highway.h>

namespace knotwave::dsp {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::FixedTag<float, 4>;
using V = hn::Vec<D>;
constexpr std::size_t kLanes = 4;

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
struct ScalarOps {
  using Value = float;
  static float set(float a) { return a; }
  static float add(float a, float b) { return a + b; }
  static float sub(float a, float b) { return a - b; }
  static float mul(float a, float b) { return a * b; }
};
struct VectorOps {
  using Value = V;
  static V set(float a) { return hn::Set(D(), a); }
  static V add(V a, V b) { return hn::Add(a, b); }
  static V sub(V a, V b) { return hn::Sub(a, b); }
  static V mul(V a, V b) { return hn::Mul(a, b); }
};

template <class Ops>
inline Weights<typename Ops::Value> weights_at(typename Ops::Value x) {
  using Value = typename Ops::Value;
  const auto quadratic = [](Value s, float c0, float c1, float c2) {
    return Ops::add(Ops::mul(Ops::add(Ops::mul(s, Ops::set(c2)), Ops::set(c1)), s), Ops::set(c0));
  };
  const auto fifth_power = [](Value a) {
    const Value square = Ops::mul(a, a);
    return Ops::mul(Ops::mul(square, square), a);
  };
  const Value s = Ops::mul(x, x);
  const Value even1 = quadratic(s, 7.40625F, 26.25F, -7.5F);
  const Value odd1 = Ops::mul(x, quadratic(s, -23.4375F, -7.5F, 5.0F));
  const Value even2 = quadratic(s, 52.5625F, -27.5F, 5.0F);
  const Value odd2 = Ops::mul(x, quadratic(s, -48.125F, 35.0F, -10.0F));
  return {{fifth_power(Ops::sub(Ops::set(0.5F), x)), Ops::add(even1, odd1), Ops::add(even2, odd2),
           Ops::sub(even2, odd2), Ops::sub(even1, odd1), fifth_power(Ops::add(Ops::set(0.5F), x))}};
}

/// The sum of taps * weights: pairs from the outside in, a tree that is part of the sound.
template <class Ops>
inline typename Ops::Value weighted(const Weights<typename Ops::Value>& w,
                                    const typename Ops::Value* t) {
  const auto outer = Ops::add(Ops::mul(w.w[0], t[0]), Ops::mul(w.w[5], t[5]));
  const auto middle = Ops::add(Ops::mul(w.w[1], t[1]), Ops::mul(w.w[4], t[4]));
  const auto inner = Ops::add(Ops::mul(w.w[2], t[2]), Ops::mul(w.w[3], t[3]));
  return Ops::add(Ops::add(outer, middle), inner);
}

/// Four samples: `taps(lane, index, low, high)` gives taps 0..3 and 4..7 of each.
template <class Taps>
inline V read_four(const base::Phase* phases, int size_log2, const Taps& taps) {
  const D d;
  alignas(16) std::int32_t fraction[kLanes];
  V low[kLanes], high[kLanes];
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Place at = place(phases[lane], size_log2);
    fraction[lane] = at.fraction;
    taps(lane, at.index, low[lane], high[lane]);
  }
  const V x = hn::Mul(hn::ConvertTo(d, hn::Load(hn::RebindToSigned<D>(), fraction)),
                      hn::Set(d, 0x1p-24F));
  const auto transpose = [d](const V* v, V* low_pair, V* high_pair) {
    const V ab = hn::InterleaveLower(d, v[0], v[1]);
    const V cd = hn::InterleaveLower(d, v[2], v[3]);
    low_pair[0] = hn::ConcatLowerLower(d, cd, ab);
    low_pair[1] = hn::ConcatUpperUpper(d, cd, ab);
    if (high_pair == nullptr) return;
    const V ab_high = hn::InterleaveUpper(d, v[0], v[1]);
    const V cd_high = hn::InterleaveUpper(d, v[2], v[3]);
    high_pair[0] = hn::ConcatLowerLower(d, cd_high, ab_high);
    high_pair[1] = hn::ConcatUpperUpper(d, cd_high, ab_high);
  };
  V t[WaveTables::kTaps];
  transpose(low, t, t + 2);
  transpose(high, t + 4, nullptr);
  return weighted<VectorOps>(weights_at<VectorOps>(x), t);
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
  return weighted<ScalarOps>(weights_at<ScalarOps>(x), taps);
}

void read_row(TableRow row, std::span<const base::Phase> phases, float* out) KNOTWAVE_RT {
  const D d;
  std::size_t i = 0;
  for (; i + kLanes <= phases.size(); i += kLanes) {
    const V y = read_four(phases.data() + i, row.size_log2,
                          [&](std::size_t, std::size_t index, V& low, V& high) {
                            low = hn::LoadU(d, row.data + index);
                            high = hn::LoadU(d, row.data + index + kLanes);
                          });
    hn::StoreU(y, d, out + i);
  }
  for (; i < phases.size(); ++i) out[i] = read_one(row, {}, phases[i]);
}

void read_blended(TableRow row, const WaveTables::RowBlend* blends, int blend_step,
                  std::span<const base::Phase> phases, float* out) KNOTWAVE_RT {
  const D d;
  const auto step = static_cast<std::size_t>(blend_step);
  std::size_t i = 0;
  for (; i + kLanes <= phases.size(); i += kLanes) {
    const V y = read_four(
        phases.data() + i, row.size_log2,
        [&](std::size_t lane, std::size_t index, V& low, V& high) {
          const WaveTables::RowBlend& blend = blends[(i + lane) * step];
          const float* at = row.data + row.row_step * static_cast<std::size_t>(blend.first) + index;
          V w = hn::Set(d, blend.weight[0]);
          low = hn::Mul(hn::LoadU(d, at), w);
          high = hn::Mul(hn::LoadU(d, at + kLanes), w);
          for (int r = 1; r < blend.count; ++r) {
            at += row.row_step;
            w = hn::Set(d, blend.weight[r]);
            low = hn::Add(low, hn::Mul(hn::LoadU(d, at), w));
            high = hn::Add(high, hn::Mul(hn::LoadU(d, at + kLanes), w));
          }
        });
    hn::StoreU(y, d, out + i);
  }
  for (; i < phases.size(); ++i) out[i] = read_one(row, blends[i * step], phases[i]);
}

}  // namespace knotwave::dsp
