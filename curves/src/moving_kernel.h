// SPDX-License-Identifier: MIT
// Times inverted side by side, with the best vector unit. Private to curves. Every kernel does the
// same operations in the same order, without fused multiply-add, so each sample has the same bits
// on every target and in every column.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "knotwave/curves/moving_curve.h"

namespace knotwave::curves {

/// One span for each of so many samples: a column each, in Bernstein form.
struct MovingBlock {
  static constexpr std::size_t kColumns = 16;
  using Row = std::array<double, kColumns>;

  std::array<Row, kMaxMovingDegree + 1> x{};  ///< weighted x - time
  std::array<Row, kMaxMovingDegree + 1> y{};  ///< weighted
  std::array<Row, kMaxMovingDegree + 1> w{};
  Row low{}, high{};  ///< bounds of y
  Row out{};
};

struct MovingKernels {
  std::int64_t unit;  ///< the vector unit compiled for, as HWY_TARGET
  /// y where x changes sign, for the first `count` columns, to block.out.
  void (*solve)(MovingBlock& block, int degree, int halvings, std::size_t count);
};

/// The kernels in use. [any]
const MovingKernels& moving_kernels() KNOTWAVE_RT;

}  // namespace knotwave::curves
