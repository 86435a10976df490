// SPDX-License-Identifier: MIT
// Runs of float32 samples that lie in one piece. Private to curves. Every kernel does the
// operations of fast_sample() in the same order, without fused multiply-add.
//
// The local parameter is s = t - 1/2, from the middle of the piece: half as large as t, so a float
// holds it with one bit more, and powers of it cancel far less. It is worked out in double at an
// anchor and goes on from there in float: s = base + k * step, k whole and below kChunk. Anchors
// are the first node of a stretch in one piece and every node whose number is a multiple of kChunk,
// so they do not depend on where blocks begin.
#pragma once
#include <cstddef>
#include <cstdint>

#include "knotwave/base/rt.h"
#include "knotwave/curves/curve_program.h"

namespace knotwave::curves {

/// Nodes from one anchor to the next.
inline constexpr std::int64_t kChunk = 256;

/// The anchor that the node would have, were all nodes in one piece.
constexpr std::int64_t chunk_start(std::int64_t node) KNOTWAVE_RT { return node & -kChunk; }

/// One coordinate of one piece on one grid. Without initial values: clearing it would cost as much
/// as ten samples.
struct FastTask {
  const float* numerator;    ///< [degree + 1], lowest power of s first
  const float* denominator;  ///< likewise, or null for a polynomial piece
  double origin, step;       ///< of the grid
  double shift;              ///< whole periods taken off u
  double start;              ///< u where t = 0
  double inverse_width;
  const float* range;  ///< [2] low, high: for pieces that are not known to stay inside
};

/// s at a node, worked out in double.
inline float anchor_of(const FastTask& task, std::int64_t node) KNOTWAVE_RT {
  const double u = task.origin + static_cast<double>(node) * task.step;
  return static_cast<float>(((u - task.shift) - task.start) * task.inverse_width - 0.5);
}
/// s from a node to the next.
inline float local_step(const FastTask& task) KNOTWAVE_RT {
  return static_cast<float>(task.step * task.inverse_width);
}

/// c[0] + c[1] s + ... by Horner.
inline float fast_horner(const float* c, int degree, float s) KNOTWAVE_RT {
  float sum = c[degree];
  for (int k = degree - 1; k >= 0; --k) sum = sum * s + c[k];
  return sum;
}

/// The sample at s: what every kernel computes.
inline float fast_sample(const FastTask& task, int degree, bool clamp, float s) KNOTWAVE_RT {
  float y = fast_horner(task.numerator, degree, s);
  if (task.denominator != nullptr) y = y / fast_horner(task.denominator, degree, s);
  if (!clamp) return y;
  y = y < task.range[0] ? task.range[0] : y;
  return y > task.range[1] ? task.range[1] : y;
}

struct FastKernels {
  std::int64_t unit;  ///< the vector unit compiled for, as HWY_TARGET
  /// out[i] = node first + i, all in the task's piece; `anchor` is that of `first`.
  using Run = void (*)(const FastTask&, std::int64_t anchor, std::int64_t first, float* out,
                       std::size_t n);
  Run run[kMaxPieceDegree + 1][2][2];  ///< [degree][is rational][clamps]
};

/// The kernels in use. [any]
const FastKernels& fast_kernels() KNOTWAVE_RT;

}  // namespace knotwave::curves
