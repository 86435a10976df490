// SPDX-License-Identifier: MIT
// The kernels of elementary_kernel.h, compiled once for each vector unit (Highway) and chosen at
// start. Each function follows its scalar twin in base/elementary.h or base/time.h operation by
// operation, so that it has its bits. Only Mul, Add, Sub, Div, Floor, selections and integer work:
// never MulAdd, whose rounding differs between targets.
#include "elementary_kernel.h"

#include "knotwave/base/elementary_coefficients.h"
#include "knotwave/curves/simd_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "elementary_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file again for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace knotwave::dsp {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace numbers = base::detail;

using Lanes = hn::ScalableTag<double>;
using FloatLanes = hn::Rebind<float, Lanes>;
using BitLanes = hn::RebindToUnsigned<Lanes>;
using Vector = hn::Vec<Lanes>;
using Bits = hn::Vec<BitLanes>;
constexpr Lanes kLanes;
constexpr BitLanes kBitLanes;

/// Lanes of the largest vector, for the last, partly filled one.
constexpr std::size_t kMaxLanes = HWY_MAX_BYTES / sizeof(double);
static_assert(kFilterChunk % kMaxLanes == 0);

/// Adding 3 * 2^51 leaves the nearest integer in the low bits; adding 2^52 an integer >= 0.
constexpr double kRoundToInteger = 0x1.8p52;
constexpr double kToInteger = 0x1p52;
constexpr double kLargest = 0x1.fffffffffffffp1023;

HWY_INLINE Vector set(double x) { return hn::Set(kLanes, x); }
HWY_INLINE Bits bits(Vector x) { return hn::BitCast(kBitLanes, x); }
HWY_INLINE Vector number(Bits x) { return hn::BitCast(kLanes, x); }
HWY_INLINE Bits set_bits(std::uint64_t x) { return hn::Set(kBitLanes, x); }

template <int count>
HWY_INLINE Vector polynomial(const double (&c)[count], Vector x) {
  Vector sum = set(c[count - 1]);
  for (int i = count - 2; i >= 0; --i) sum = hn::Add(hn::Mul(sum, x), set(c[i]));
  return sum;
}

HWY_INLINE Vector round_off(Vector sum) { return hn::Sub(sum, set(kRoundToInteger)); }

HWY_INLINE Vector clamp_or(Vector x, double low, double high, double if_nan) {
  const Vector at_least = hn::IfThenElse(hn::Lt(x, set(low)), set(low), x);
  const Vector inside = hn::IfThenElse(hn::Gt(at_least, set(high)), set(high), at_least);
  return hn::IfThenElse(hn::Eq(x, x), inside, set(if_nan));
}

/// 2^(n + r), n the integer in the low bits of `n_bits`; detail::exp2_scaled().
HWY_INLINE Vector exp2_scaled(Vector r, Vector n_bits) {
  const Vector ln2_high = set(numbers::kLn2High);
  const Vector high_half = hn::Sub(hn::Add(r, set(0x1.8p26)), set(0x1.8p26));
  const Vector high = hn::Mul(high_half, ln2_high);
  const Vector rest = hn::Add(hn::Mul(r, set(numbers::kLn2Low)),
                              hn::Mul(hn::Mul(r, r), polynomial(numbers::kExp2Rest, r)));
  const Vector low = hn::Add(hn::Mul(hn::Sub(r, high_half), ln2_high), rest);
  const Vector head = hn::Add(set(1), high);
  const Vector tail = hn::Add(hn::Add(hn::Sub(set(1), head), high), low);
  const Vector power = hn::Add(head, tail);
  return number(hn::Add(bits(power), hn::ShiftLeft<52>(bits(n_bits))));
}

struct Exp2 {
  static HWY_INLINE Vector of(Vector x) {
    const Vector inside = clamp_or(x, -1022.0, 0x1.fffffffffffffp9, 0.0);
    const Vector rounded = hn::Add(inside, set(kRoundToInteger));
    const Vector power = exp2_scaled(hn::Sub(inside, round_off(rounded)), rounded);
    const Vector not_small = hn::IfThenElse(hn::Lt(x, set(-1022.0)), set(0), power);
    return hn::IfThenElse(hn::Ge(x, set(1024.0)), set(kLargest), not_small);
  }
};

struct DbToGain {
  static HWY_INLINE Vector of(Vector db) {
    const Vector inside = clamp_or(db, -6153.0, 6165.0, 0.0);
    const Vector octaves_per_db = set(numbers::kOctavesPerDb);
    const Vector rounded = hn::Add(hn::Mul(inside, octaves_per_db), set(kRoundToInteger));
    const Vector octaves = round_off(rounded);
    const Vector left = hn::Sub(hn::Sub(inside, hn::Mul(octaves, set(numbers::kOctaveDbHigh))),
                                hn::Mul(octaves, set(numbers::kOctaveDbLow)));
    const Vector gain = exp2_scaled(hn::Mul(left, octaves_per_db), rounded);
    const Vector not_small = hn::IfThenElse(hn::Lt(db, set(-6153.0)), set(0), gain);
    return hn::IfThenElse(hn::Ge(db, set(6165.0)), set(kLargest), not_small);
  }
};

HWY_INLINE Vector note_to_hz(Vector note) {
  const Vector from_a4 = hn::Sub(clamp_or(note, -12000.0, 12000.0, 69.0), set(69.0));
  const Vector rounded = hn::Add(hn::Mul(from_a4, set(1.0 / 12.0)), set(kRoundToInteger));
  const Vector left = hn::Sub(from_a4, hn::Mul(set(12.0), round_off(rounded)));
  return hn::Mul(set(440.0), exp2_scaled(hn::Div(left, set(12.0)), rounded));
}

/// Whole part of 0 <= x <= 2^63, in two halves of 32 bits, each exact.
HWY_INLINE Bits truncated(Vector x) {
  const Vector top = hn::Floor(hn::Mul(x, set(0x1p-32)));
  const Vector bottom = hn::Floor(hn::Sub(x, hn::Mul(top, set(0x1p32))));
  const Bits low = hn::And(bits(hn::Add(bottom, set(kToInteger))), set_bits(0xffffffffU));
  return hn::Or(hn::ShiftLeft<32>(bits(hn::Add(top, set(kToInteger)))), low);
}

/// base::phase_increment() of frequencies above 0, rate above 0.
HWY_INLINE Bits increment(Vector hz, double rate_hz) {
  const auto folds = hn::Ge(hz, set(0.5 * rate_hz));
  const Vector scaled = hn::Mul(hn::Div(hz, set(rate_hz)), set(0x1p64));
  return truncated(hn::IfThenElse(folds, set(0x1p63), scaled));
}

/// base::Phase::cycles(): the upper 53 bits, in two halves that a double holds exactly.
HWY_INLINE Vector cycles(Bits phase) {
  const Bits whole = hn::ShiftRight<11>(phase);
  const Bits low = hn::Or(hn::And(whole, set_bits(0xffffffffU)), bits(set(0x1p52)));
  const Bits high = hn::Or(hn::ShiftRight<32>(whole), bits(set(0x1p84)));
  const Vector sum = hn::Add(hn::Sub(number(high), set(0x1p84 + 0x1p52)), number(low));
  return hn::Mul(sum, set(0x1p-53));
}

struct SinCosVector {
  Vector sin, cos;
};
/// base::sin_cos_cycles().
HWY_INLINE SinCosVector sin_cos_cycles(Vector x) {
  const auto in_range = hn::And(hn::Lt(x, set(0x1p51)), hn::Gt(x, set(-0x1p51)));
  const Vector inside = hn::IfThenElseZero(in_range, x);
  const Vector cycle = hn::Sub(inside, round_off(hn::Add(inside, set(kRoundToInteger))));
  const Vector rounded = hn::Add(hn::Mul(set(4.0), cycle), set(kRoundToInteger));
  const Vector r = hn::Sub(cycle, hn::Mul(set(0.25), round_off(rounded)));
  const Vector z = hn::Mul(r, r);
  const Vector sin_rest = hn::Mul(z, polynomial(numbers::kSinRest, z));
  const Bits sin_r = bits(hn::Mul(r, hn::Add(set(numbers::kTwoPi), sin_rest)));
  const Bits cos_r = bits(hn::Add(set(1.0), hn::Mul(z, polynomial(numbers::kCosRest, z))));
  const Bits quarter = bits(rounded);
  const Bits swap = hn::Sub(set_bits(0), hn::And(quarter, set_bits(1)));
  const Bits difference = hn::And(hn::Xor(sin_r, cos_r), swap);
  const Bits sin_sign = hn::ShiftLeft<62>(hn::And(quarter, set_bits(2)));
  const Bits cos_sign = hn::ShiftLeft<62>(hn::And(hn::Add(quarter, set_bits(1)), set_bits(2)));
  return {number(hn::Xor(hn::Xor(sin_r, difference), sin_sign)),
          number(hn::Xor(hn::Xor(cos_r, difference), cos_sign))};
}

/// The first lanes of a vector; what it holds beyond n is 0.
HWY_INLINE Vector load_part(const double* HWY_RESTRICT from, std::size_t n) {
  double part[kMaxLanes] = {};
  for (std::size_t k = 0; k < n; ++k) part[k] = from[k];
  return hn::LoadU(kLanes, part);
}

template <class Function>
HWY_INLINE void for_each(const double* in, double* out, std::size_t n) {
  const std::size_t lanes = hn::Lanes(kLanes);
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    hn::StoreU(Function::of(hn::LoadU(kLanes, in + i)), kLanes, out + i);
  }
  if (i == n) return;
  double part[kMaxLanes];
  hn::StoreU(Function::of(load_part(in + i, n - i)), kLanes, part);
  for (std::size_t k = i; k < n; ++k) out[k] = part[k - i];
}

void exp2(const double* in, double* out, std::size_t n) { for_each<Exp2>(in, out, n); }
void db_to_gain(const double* in, double* out, std::size_t n) { for_each<DbToGain>(in, out, n); }

void note_increments(const double* notes, double rate_hz, base::Phase* out, std::size_t n) {
  const std::size_t lanes = hn::Lanes(kLanes);
  std::uint64_t part[kMaxLanes];
  for (std::size_t i = 0; i < n; i += lanes) {
    const std::size_t count = n - i < lanes ? n - i : lanes;
    const bool whole = count == lanes;
    const Vector note = whole ? hn::LoadU(kLanes, notes + i) : load_part(notes + i, count);
    hn::StoreU(increment(note_to_hz(note), rate_hz), kBitLanes, part);
    for (std::size_t k = 0; k < count; ++k) out[i + k].value = part[k];
  }
}

void phase_ramp(base::Phase first, base::Phase step, double origin, double width, double* out,
                std::size_t n) {
  const std::size_t lanes = hn::Lanes(kLanes);
  std::uint64_t start[kMaxLanes] = {};
  for (std::size_t k = 0; k < lanes; ++k) start[k] = first.value + k * step.value;
  Bits phase = hn::LoadU(kBitLanes, start);
  const Bits stride = set_bits(lanes * step.value);
  for (std::size_t i = 0; i < n; i += lanes) {
    const Vector place = hn::Add(set(origin), hn::Mul(cycles(phase), set(width)));
    if (i + lanes <= n) {
      hn::StoreU(place, kLanes, out + i);
    } else {
      double part[kMaxLanes];
      hn::StoreU(place, kLanes, part);
      for (std::size_t k = i; k < n; ++k) out[k] = part[k - i];
    }
    phase = hn::Add(phase, stride);
  }
}

// g = s / c, so that no quotient but one is needed.
void filter(const float* cutoff_hz, const CutoffRange& range, FilterCoefficients& to,
            std::size_t n) {
  const std::size_t lanes = hn::Lanes(kLanes);
  const Vector low = set(range.low_hz), high = set(range.high_hz);
  float part[kMaxLanes] = {};
  for (std::size_t i = 0; i < n; i += lanes) {
    const float* from = cutoff_hz + i;
    const bool whole = n - i >= lanes;
    if (!whole) {
      for (std::size_t j = i; j < n; ++j) part[j - i] = cutoff_hz[j];
      from = part;
    }
    const Vector wanted = hn::PromoteTo(kLanes, hn::LoadU(FloatLanes(), from));
    const Vector at_least = hn::IfThenElse(hn::Gt(wanted, low), wanted, low);
    const Vector cutoff = hn::IfThenElse(hn::Lt(at_least, high), at_least, high);
    const SinCosVector half_turn = sin_cos_cycles(hn::Mul(cutoff, set(range.half_cycles_per_hz)));
    const Vector s = half_turn.sin, c = half_turn.cos;
    const double* damping = to.k.data() + i;
    const Vector k = whole ? hn::LoadU(kLanes, damping) : load_part(damping, n - i);
    const Vector cc = hn::Mul(c, c);
    const Vector scale = hn::Div(set(1), hn::Add(cc, hn::Mul(s, hn::Add(s, hn::Mul(k, c)))));
    hn::StoreU(hn::Mul(cc, scale), kLanes, to.a1.data() + i);
    hn::StoreU(hn::Mul(hn::Mul(s, c), scale), kLanes, to.a2.data() + i);
    hn::StoreU(hn::Mul(hn::Mul(s, s), scale), kLanes, to.a3.data() + i);
  }
}

const ElementaryKernels* elementary_kernels() {
  static constexpr ElementaryKernels kKernels = {HWY_TARGET,      exp2,       db_to_gain,
                                                 note_increments, phase_ramp, filter};
  return &kKernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace knotwave::dsp
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace knotwave::dsp {
namespace {
HWY_EXPORT(elementary_kernels);
const curves::SimdKernels<ElementaryKernels> kernels_of("elementary functions",
                                                        HWY_DYNAMIC_DISPATCH(elementary_kernels),
                                                        HWY_CHOOSE_AVX2(elementary_kernels),
                                                        HWY_STATIC_DISPATCH(elementary_kernels));
}  // namespace

const ElementaryKernels& elementary_kernels_in_use() KNOTWAVE_RT {
  return kernels_of.in_use(HWY_STATIC_DISPATCH(elementary_kernels));
}

}  // namespace knotwave::dsp
#endif  // HWY_ONCE
