// SPDX-License-Identifier: MIT
// The kernel of moving_kernel.h, compiled once for each vector unit (Highway) and chosen at start.
// Only Mul, Add, Sub, Div and selections: never MulAdd, whose rounding differs between targets.
#include "moving_kernel.h"

#include "knotwave/curves/simd_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "moving_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file again for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace knotwave::curves {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, 8>;
using Vector = hn::Vec<Lanes>;
constexpr Lanes kLanes;

/// As many columns as a vector has.
template <int Degree>
struct Columns {
  Vector x[Degree + 1];
  Vector t;

  HWY_INLINE void load(const MovingBlock& block, std::size_t first) {
    for (int j = 0; j <= Degree; ++j) {
      x[j] = hn::LoadU(kLanes, &block.x[static_cast<std::size_t>(j)][first]);
    }
    t = hn::Zero(kLanes);
  }

  /// The half of [0, 1] in which x changes sign becomes all of x; t goes to where it begins. de
  /// Casteljau at 1/2 with sums, scaled at the end: powers of 2 are exact.
  HWY_INLINE void halve(double width) {
    Vector right[Degree + 1], left[Degree + 1];
    for (int j = 0; j <= Degree; ++j) right[j] = x[j];
    left[0] = x[0];
    double scale = 1;
    for (int level = 1; level <= Degree; ++level) {
      for (int j = 0; j + level <= Degree; ++j) right[j] = hn::Add(right[j], right[j + 1]);
      scale *= 0.5;
      left[level] = hn::Mul(right[0], hn::Set(kLanes, scale));
    }
    const auto later = hn::Le(left[Degree], hn::Zero(kLanes));
    for (int j = 0; j <= Degree; ++j) {
      if (j > 0) right[j] = hn::Mul(right[j], hn::Set(kLanes, scale));
      x[j] = hn::IfThenElse(later, j > 0 ? right[j] : left[Degree], left[j]);
      scale *= 2;
    }
    t = hn::Add(t, hn::IfThenElseZero(later, hn::Set(kLanes, width)));
  }

  /// The value of a row at `place` by de Casteljau.
  HWY_INLINE Vector value(const std::array<MovingBlock::Row, kMaxMovingDegree + 1>& rows,
                          std::size_t first, Vector place) const {
    const Vector rest = hn::Sub(hn::Set(kLanes, 1.0), place);
    Vector row[Degree + 1];
    for (int j = 0; j <= Degree; ++j) {
      row[j] = hn::LoadU(kLanes, &rows[static_cast<std::size_t>(j)][first]);
    }
    for (int level = 1; level <= Degree; ++level) {
      for (int j = 0; j + level <= Degree; ++j) {
        row[j] = hn::Add(hn::Mul(rest, row[j]), hn::Mul(place, row[j + 1]));
      }
    }
    return row[0];
  }

  HWY_INLINE void store(MovingBlock& block, std::size_t first, double width) const {
    // The chord meets 0 within the last half; there is none where the time is beyond an end.
    const Vector zero = hn::Zero(kLanes), one = hn::Set(kLanes, 1.0);
    const Vector before = x[0], after = x[Degree];
    const auto inside = hn::And(hn::Lt(before, zero), hn::Gt(after, zero));
    const Vector rise = hn::IfThenElse(inside, hn::Sub(before, after), one);
    const Vector chord = hn::IfThenElseZero(inside, hn::Div(before, rise));
    const Vector share = hn::IfThenElse(hn::Gt(after, zero), chord, one);
    const Vector place = hn::Add(t, hn::Mul(hn::Set(kLanes, width), share));
    Vector y = hn::Div(value(block.y, first, place), value(block.w, first, place));
    const Vector low = hn::LoadU(kLanes, &block.low[first]);
    const Vector high = hn::LoadU(kLanes, &block.high[first]);
    y = hn::IfThenElse(hn::Lt(y, low), low, y);
    y = hn::IfThenElse(hn::Gt(y, high), high, y);
    hn::StoreU(y, kLanes, &block.out[first]);
  }
};

/// Two vectors at a time: each waits for its own sums only.
template <int Degree>
void solve(MovingBlock& block, int halvings, std::size_t count) {
  const std::size_t lanes = hn::Lanes(kLanes);
  for (std::size_t first = 0; first < count; first += 2 * lanes) {
    Columns<Degree> a, b;
    a.load(block, first);
    b.load(block, first + lanes);
    double width = 1;
    for (int i = 0; i < halvings; ++i) {
      width *= 0.5;
      a.halve(width);
      b.halve(width);
    }
    a.store(block, first, width);
    b.store(block, first + lanes, width);
  }
}

void solve_degree(MovingBlock& block, int degree, int halvings, std::size_t count) {
  static_assert(kMaxMovingDegree == 7);
  switch (degree) {
    case 1:
      return solve<1>(block, halvings, count);
    case 2:
      return solve<2>(block, halvings, count);
    case 3:
      return solve<3>(block, halvings, count);
    case 4:
      return solve<4>(block, halvings, count);
    case 5:
      return solve<5>(block, halvings, count);
    case 6:
      return solve<6>(block, halvings, count);
    default:
      return solve<7>(block, halvings, count);
  }
}

const MovingKernels* moving_kernels_here() {
  static constexpr MovingKernels kKernels = {HWY_TARGET, solve_degree};
  return &kKernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace knotwave::curves
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace knotwave::curves {
namespace {
HWY_EXPORT(moving_kernels_here);
const SimdKernels<MovingKernels> kernels_of("moving curves",
                                            HWY_DYNAMIC_DISPATCH(moving_kernels_here),
                                            HWY_CHOOSE_AVX2(moving_kernels_here),
                                            HWY_STATIC_DISPATCH(moving_kernels_here));
}  // namespace

const MovingKernels& moving_kernels() KNOTWAVE_RT {
  return kernels_of.in_use(HWY_STATIC_DISPATCH(moving_kernels_here));
}

}  // namespace knotwave::curves
#endif  // HWY_ONCE
