// SPDX-License-Identifier: MIT
// The kernels of grid_kernel.h, compiled once for each vector unit (Highway) and chosen at start.
// Only Mul, Add, Sub, Div and selections: never MulAdd, whose rounding differs between targets.
#include "grid_kernel.h"

#include "knotwave/curves/curve_program.h"
#include "knotwave/curves/simd_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grid_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file again for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace knotwave::curves {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::ScalableTag<double>;
using FloatLanes = hn::Rebind<float, Lanes>;
using Vector = hn::Vec<Lanes>;
constexpr Lanes kLanes;

/// Bytes of the largest vector, for the last, partly filled one.
constexpr std::size_t kMaxLanes = HWY_MAX_BYTES / sizeof(double);

template <int Degree>
HWY_INLINE Vector horner(const double* HWY_RESTRICT c, Vector t) {
  Vector sum = hn::Set(kLanes, c[Degree]);
  for (int k = Degree - 1; k >= 0; --k) sum = hn::Add(hn::Mul(sum, t), hn::Set(kLanes, c[k]));
  return sum;
}

HWY_INLINE Vector clamp_to(Vector y, double low, double high) {
  const Vector least = hn::Set(kLanes, low);
  const Vector most = hn::Set(kLanes, high);
#if HWY_ARCH_X86
  // maxpd and minpd give their second operand where the two are equal or one is NaN, which are the
  // bits of clamp_to_hull().
  return hn::Min(most, hn::Max(least, y));
#else
  y = hn::IfThenElse(hn::Lt(y, least), least, y);
  return hn::IfThenElse(hn::Gt(y, most), most, y);
#endif
}

/// Numbers that every lane takes, kept in registers.
template <int Degree>
struct GridRow {
  Vector c[Degree + 1];

  explicit HWY_INLINE GridRow(const double* row) {
    for (int k = 0; k <= Degree; ++k) c[k] = hn::Set(kLanes, row[k]);
  }
  HWY_INLINE Vector at(Vector t) const {
    Vector sum = c[Degree];
    for (int k = Degree - 1; k >= 0; --k) sum = hn::Add(hn::Mul(sum, t), c[k]);
    return sum;
  }
};

/// u to value, without controls. Shifted: whole periods are taken off u; taking off 0 would change
/// no bit.
template <int Degree, bool Rational, bool Clamp, bool Shifted>
struct Piece {
  GridRow<Degree> numerator;
  GridRow<Degree* int{Rational}> denominator;
  Vector shift, start, inverse_width;
  double low, high;

  explicit HWY_INLINE Piece(const PieceTask& task)
      : numerator(task.numerator),
        denominator(Rational ? task.denominator : task.numerator),
        shift(hn::Set(kLanes, task.shift)),
        start(hn::Set(kLanes, task.start)),
        inverse_width(hn::Set(kLanes, task.inverse_width)),
        low(task.low),
        high(task.high) {}

  HWY_INLINE Vector at(Vector u) const {
    if constexpr (Shifted) u = hn::Sub(u, shift);
    const Vector t = hn::Mul(hn::Sub(u, start), inverse_width);
    Vector y = numerator.at(t);
    if constexpr (Rational) y = hn::Div(y, denominator.at(t));
    if constexpr (Clamp) y = clamp_to(y, low, high);
    return y;
  }
};

HWY_INLINE void store(Vector y, double* HWY_RESTRICT out) { hn::StoreU(y, kLanes, out); }
HWY_INLINE void store(Vector y, float* HWY_RESTRICT out) {
  hn::StoreU(hn::DemoteTo(FloatLanes(), y), FloatLanes(), out);
}

template <class Float>
HWY_INLINE void store_part(Vector y, Float* HWY_RESTRICT out, std::size_t n) {
  Float part[kMaxLanes];
  store(y, part);
  for (std::size_t i = 0; i < n; ++i) out[i] = part[i];
}

template <class Evaluator, class Float>
HWY_INLINE void render_grid(const Evaluator& piece, double origin, double step, double index,
                            Float* HWY_RESTRICT out, std::size_t n) {
  const std::size_t lanes = hn::Lanes(kLanes);
  const Vector first = hn::Set(kLanes, origin);
  const Vector by = hn::Set(kLanes, step);
  const Vector stride = hn::Set(kLanes, static_cast<double>(lanes));
  Vector node = hn::Iota(kLanes, index);  // whole numbers below 2^53: sums are exact
  std::size_t i = 0;
  // Two at once: a sum of nodes has time to finish.
  const Vector two = hn::Add(stride, stride);
  Vector next = hn::Add(node, stride);
  for (; i + 2 * lanes <= n; i += 2 * lanes) {
    store(piece.at(hn::Add(first, hn::Mul(node, by))), out + i);
    store(piece.at(hn::Add(first, hn::Mul(next, by))), out + i + lanes);
    node = hn::Add(node, two);
    next = hn::Add(next, two);
  }
  for (; i + lanes <= n; i += lanes) {
    store(piece.at(hn::Add(first, hn::Mul(node, by))), out + i);
    node = hn::Add(node, stride);
  }
  if (i == n) return;
  // The last full vector once more, shifted back: a node's bits do not hang on its lane.
  const bool shifted = n >= lanes;
  if (shifted) node = hn::Iota(kLanes, index + static_cast<double>(n - lanes));
  const Vector y = piece.at(hn::Add(first, hn::Mul(node, by)));
  if (shifted) {
    store(y, out + (n - lanes));
  } else {
    store_part(y, out, n);
  }
}

template <class Evaluator>
HWY_INLINE void render_array(const Evaluator& piece, const double* HWY_RESTRICT u,
                             double* HWY_RESTRICT out, std::size_t n) {
  const std::size_t lanes = hn::Lanes(kLanes);
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) store(piece.at(hn::LoadU(kLanes, u + i)), out + i);
  if (i == n) return;
  double part[kMaxLanes] = {};
  for (std::size_t k = i; k < n; ++k) part[k - i] = u[k];
  store_part(piece.at(hn::LoadU(kLanes, part)), out + i, n - i);
}

/// Calls run(Piece<...>) with what the task says fixed at compile time.
template <int Degree, bool Rational, class Run>
HWY_INLINE void with_form(const PieceTask& task, const Run& run) {
  // A shifted piece is clamped where it need not be: that changes no bit either.
  if (task.shift != 0) return run(Piece<Degree, Rational, true, true>(task));
  if (task.clamp) return run(Piece<Degree, Rational, true, false>(task));
  return run(Piece<Degree, Rational, false, false>(task));
}

template <int Degree, class Run>
HWY_INLINE void with_degree(const PieceTask& task, const Run& run) {
  task.denominator == nullptr ? with_form<Degree, false>(task, run)
                              : with_form<Degree, true>(task, run);
}

template <class Run>
HWY_INLINE void with_piece(const PieceTask& task, const Run& run) {
  static_assert(kMaxPieceDegree == 7);
  switch (task.degree) {
    case 0:
      return with_degree<0>(task, run);
    case 1:
      return with_degree<1>(task, run);
    case 2:
      return with_degree<2>(task, run);
    case 3:
      return with_degree<3>(task, run);
    case 4:
      return with_degree<4>(task, run);
    case 5:
      return with_degree<5>(task, run);
    case 6:
      return with_degree<6>(task, run);
    default:
      return with_degree<7>(task, run);
  }
}

void grid_float(const PieceTask& task, double origin, double step, double index, float* out,
                std::size_t n) {
  with_piece(task,
             [&](const auto& piece) HWY_ATTR { render_grid(piece, origin, step, index, out, n); });
}

void grid_double(const PieceTask& task, double origin, double step, double index, double* out,
                 std::size_t n) {
  with_piece(task,
             [&](const auto& piece) HWY_ATTR { render_grid(piece, origin, step, index, out, n); });
}

void array(const PieceTask& task, const double* u, double* out, std::size_t n) {
  with_piece(task, [&](const auto& piece) HWY_ATTR { render_array(piece, u, out, n); });
}

template <int Degree>
HWY_INLINE Vector moved(const double* terms, const PieceTask& task, const double* moves,
                        const ControlTask& controls, Vector t) {
  Vector sum = horner<Degree>(terms, t);
  for (int k = 0; k < controls.count; ++k) {
    const std::size_t index = static_cast<std::size_t>(k);
    const Vector move = hn::LoadU(kLanes, moves + index * kMaxLanes);
    const Vector term = horner<Degree>(terms + (index + 1) * task.term_stride, t);
    sum = hn::Add(sum, hn::Mul(move, term));
  }
  return sum;
}

HWY_INLINE Vector moves_of(Vector value, double rest, double low, double high) {
  const Vector move = hn::Sub(clamp_to(value, low, high), hn::Set(kLanes, rest));
  return hn::IfThenElseZero(hn::Eq(value, value), move);
}

template <int Degree>
void controls_of_degree(const PieceTask& task, const ControlTask& controls, const double* u,
                        double* out, std::size_t n) {
  const std::size_t lanes = hn::Lanes(kLanes);
  double moves[kMaxControls * kMaxLanes];
  double part[kMaxLanes] = {};
  for (std::size_t i = 0; i < n; i += lanes) {
    const std::size_t count = n - i < lanes ? n - i : lanes;
    for (int k = 0; k < controls.count; ++k) {
      const double* values = controls.values[k] + controls.offset + i;
      for (std::size_t j = 0; j < count; ++j) part[j] = values[j];
      hn::StoreU(
          moves_of(hn::LoadU(kLanes, part), controls.rest[k], controls.low[k], controls.high[k]),
          kLanes, moves + static_cast<std::size_t>(k) * kMaxLanes);
    }
    for (std::size_t j = 0; j < count; ++j) part[j] = u[i + j];
    const Vector local = hn::Sub(hn::Sub(hn::LoadU(kLanes, part), hn::Set(kLanes, task.shift)),
                                 hn::Set(kLanes, task.start));
    const Vector t = hn::Mul(local, hn::Set(kLanes, task.inverse_width));
    Vector y = moved<Degree>(task.numerator, task, moves, controls, t);
    if (task.denominator != nullptr) {
      y = hn::Div(y, moved<Degree>(task.denominator, task, moves, controls, t));
    }
    if (task.clamp) y = clamp_to(y, task.low, task.high);
    store_part(y, out + i, count);
  }
}

void array_controls(const PieceTask& task, const ControlTask& controls, const double* u,
                    double* out, std::size_t n) {
  switch (task.degree) {
    case 0:
      return controls_of_degree<0>(task, controls, u, out, n);
    case 1:
      return controls_of_degree<1>(task, controls, u, out, n);
    case 2:
      return controls_of_degree<2>(task, controls, u, out, n);
    case 3:
      return controls_of_degree<3>(task, controls, u, out, n);
    case 4:
      return controls_of_degree<4>(task, controls, u, out, n);
    case 5:
      return controls_of_degree<5>(task, controls, u, out, n);
    case 6:
      return controls_of_degree<6>(task, controls, u, out, n);
    default:
      return controls_of_degree<7>(task, controls, u, out, n);
  }
}

const GridKernels* kernels() {
  static constexpr GridKernels kKernels = {HWY_TARGET, grid_float, grid_double, array,
                                           array_controls};
  return &kKernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace knotwave::curves
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace knotwave::curves {
namespace {
HWY_EXPORT(kernels);
const SimdKernels<GridKernels> kernels_of("grid in double", HWY_DYNAMIC_DISPATCH(kernels),
                                          HWY_CHOOSE_AVX2(kernels), HWY_STATIC_DISPATCH(kernels));
}  // namespace

const GridKernels& grid_kernels() KNOTWAVE_RT {
  return kernels_of.in_use(HWY_STATIC_DISPATCH(kernels));
}

}  // namespace knotwave::curves
#endif  // HWY_ONCE
