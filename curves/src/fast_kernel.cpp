// SPDX-License-Identifier: MIT
// The kernels of fast_kernel.h, compiled once for each vector unit (Highway) and chosen at start.
// Only Mul, Add, Div and selections: never MulAdd, whose rounding differs between targets.
#include "fast_kernel.h"

#include <algorithm>
#include <utility>

#include "knotwave/curves/simd_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file again for each target.
#include <hwy/highway.h>

#ifndef KNOTWAVE_FAST_KERNEL_NODES
#define KNOTWAVE_FAST_KERNEL_NODES
namespace knotwave::curves {

inline constexpr std::size_t kMostLanes = 16;

/// 0, 1, 2 ... as floats: a chunk, and what a last, partly filled vector reads beyond it.
struct NodeNumbers {
  alignas(64) float value[std::size_t(kChunk) + kMostLanes];
  constexpr NodeNumbers() : value{} {
    for (std::size_t i = 0; i < std::size(value); ++i) value[i] = static_cast<float>(i);
  }
};
inline constexpr NodeNumbers kNodes;

}  // namespace knotwave::curves
#endif

HWY_BEFORE_NAMESPACE();
namespace knotwave::curves {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, kMostLanes>;
using Vector = hn::Vec<Lanes>;
constexpr Lanes kLanes;

/// Numbers that every lane takes, kept in registers.
template <int Degree>
struct Coefficients {
  Vector c[Degree + 1];

  explicit HWY_INLINE Coefficients(const float* row) {
    for (int k = 0; k <= Degree; ++k) c[k] = hn::Set(kLanes, row[k]);
  }
  HWY_INLINE Vector at(Vector s) const {
    Vector sum = c[Degree];
    for (int k = Degree - 1; k >= 0; --k) sum = hn::Add(hn::Mul(sum, s), c[k]);
    return sum;
  }
};

template <int Degree, bool Rational, bool Clamp>
struct FastPiece {
  Coefficients<Degree> numerator;
  Coefficients<Degree* int{Rational}> denominator;
  Vector step, low, high;

  explicit HWY_INLINE FastPiece(const FastTask& task)
      : numerator(task.numerator),
        denominator(Rational ? task.denominator : task.numerator),
        step(hn::Set(kLanes, local_step(task))),
        low(hn::Set(kLanes, task.range[0])),
        high(hn::Set(kLanes, task.range[1])) {}

  HWY_INLINE Vector at(Vector base, const float* nodes) const {
    const Vector s = hn::Add(base, hn::Mul(hn::LoadU(kLanes, nodes), step));
    Vector y = numerator.at(s);
    if constexpr (Rational) y = hn::Div(y, denominator.at(s));
    if constexpr (Clamp) {
#if HWY_ARCH_X86
      // maxps and minps give their second operand where the two are equal.
      y = hn::Min(high, hn::Max(low, y));
#else
      y = hn::IfThenElse(hn::Lt(y, low), low, y);
      y = hn::IfThenElse(hn::Gt(y, high), high, y);
#endif
    }
    return y;
  }
};

/// Fewer nodes than a vector has: rare, and kept out of the way of the others' registers.
template <class Piece>
HWY_NOINLINE void fill_few(const FastTask& task, float base, std::size_t k, float* out,
                           std::size_t n) {
  float part[kMostLanes];
  hn::StoreU(Piece(task).at(hn::Set(kLanes, base), kNodes.value + k), kLanes, part);
  for (std::size_t i = 0; i < n; ++i) out[i] = part[i];
}

/// n nodes of one chunk, the first `k` after the anchor.
template <class Piece>
HWY_INLINE void fill_chunk(const Piece& piece, float base, std::size_t k, float* HWY_RESTRICT out,
                           std::size_t n) {
  const std::size_t lanes = hn::Lanes(kLanes);
  const Vector from = hn::Set(kLanes, base);
  const float* const nodes = kNodes.value + k;
  std::size_t i = 0;
  for (; i + 4 * lanes <= n; i += 4 * lanes) {  // four at once: a count and a branch less for each
    hn::StoreU(piece.at(from, nodes + i), kLanes, out + i);
    hn::StoreU(piece.at(from, nodes + i + lanes), kLanes, out + i + lanes);
    hn::StoreU(piece.at(from, nodes + i + 2 * lanes), kLanes, out + i + 2 * lanes);
    hn::StoreU(piece.at(from, nodes + i + 3 * lanes), kLanes, out + i + 3 * lanes);
  }
  for (; i + lanes <= n; i += lanes) hn::StoreU(piece.at(from, nodes + i), kLanes, out + i);
  // The last ones once more, together with what is left: a node's bits do not hang on its lane.
  if (n % lanes != 0) hn::StoreU(piece.at(from, nodes + (n - lanes)), kLanes, out + (n - lanes));
}

/// Any stretch: chunk after chunk.
template <class Piece>
HWY_NOINLINE void run_chunks(const FastTask& task, std::int64_t anchor, std::int64_t first,
                             float* HWY_RESTRICT out, std::size_t n) {
  const Piece piece(task);
  while (n > 0) {
    const std::int64_t rest = kChunk - (first - chunk_start(first));
    const std::size_t here = std::min(n, static_cast<std::size_t>(rest));
    const float base = anchor_of(task, anchor);
    const auto k = static_cast<std::size_t>(first - anchor);
    here < hn::Lanes(kLanes) ? fill_few<Piece>(task, base, k, out, here)
                             : fill_chunk(piece, base, k, out, here);
    out += here;
    n -= here;
    first += static_cast<std::int64_t>(here);
    anchor = first;
  }
}

/// Most blocks lie in one chunk: those in as few steps as can be.
template <int Degree, bool Rational, bool Clamp>
void run_fast(const FastTask& task, std::int64_t anchor, std::int64_t first,
              float* HWY_RESTRICT out, std::size_t n) {
  using Piece = FastPiece<Degree, Rational, Clamp>;
  const auto rest = static_cast<std::size_t>(kChunk - (first - chunk_start(first)));
  if (n > rest || n < hn::Lanes(kLanes)) return run_chunks<Piece>(task, anchor, first, out, n);
  const auto k = static_cast<std::size_t>(first - anchor);
  fill_chunk(Piece(task), anchor_of(task, anchor), k, out, n);
}

template <int... Degrees>
constexpr FastKernels make_fast_kernels(std::integer_sequence<int, Degrees...>) {
  return {HWY_TARGET,
          {{{run_fast<Degrees, false, false>, run_fast<Degrees, false, true>},
            {run_fast<Degrees, true, false>, run_fast<Degrees, true, true>}}...}};
}

const FastKernels* fast_kernels_here() {
  static constexpr FastKernels kKernels =
      make_fast_kernels(std::make_integer_sequence<int, kMaxPieceDegree + 1>());
  return &kKernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace knotwave::curves
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace knotwave::curves {
namespace {
HWY_EXPORT(fast_kernels_here);
const SimdKernels<FastKernels> kernels_of("grid in float", HWY_DYNAMIC_DISPATCH(fast_kernels_here),
                                          HWY_CHOOSE_AVX2(fast_kernels_here),
                                          HWY_STATIC_DISPATCH(fast_kernels_here));
}  // namespace

const FastKernels& fast_kernels() KNOTWAVE_RT {
  return kernels_of.in_use(HWY_STATIC_DISPATCH(fast_kernels_here));
}

}  // namespace knotwave::curves
#endif  // HWY_ONCE
