// SPDX-License-Identifier: MIT
// Runs of samples that lie in one piece, rendered with the best vector unit. Private to curves.
// Every kernel does the operations of sample_piece() in the same order, without fused multiply-add,
// so each sample has the bits of the scalar evaluation on every target.
#pragma once
#include <cstddef>
#include <cstdint>

#include "knotwave/base/rt.h"

namespace knotwave::curves {

/// One coordinate of one piece, as kernels read it.
struct PieceTask {
  const double* numerator = nullptr;    ///< [degree + 1], lowest power of t first; term 0
  const double* denominator = nullptr;  ///< likewise, or null for a polynomial piece
  std::size_t term_stride = 0;          ///< from a term to the next (one a control)
  int degree = 0;
  double shift = 0;  ///< whole periods taken off u
  double start = 0;  ///< u where t = 0
  double inverse_width = 1;
  double low = 0, high = 0;
  bool clamp = true;  ///< false where the piece is known to stay inside low..high
};

/// What controllers do, for kernels: value k of sample i is values[k][offset + i].
struct ControlTask {
  int count = 0;
  const double* const* values = nullptr;
  std::size_t offset = 0;
  const double* rest = nullptr;
  const double* low = nullptr;
  const double* high = nullptr;
};

struct GridKernels {
  std::int64_t unit;  ///< the vector unit compiled for, as HWY_TARGET
  /// out[i] = piece at origin + (index + i) * step; index + n < 2^53.
  void (*grid_float)(const PieceTask&, double origin, double step, double index, float* out,
                     std::size_t n);
  void (*grid_double)(const PieceTask&, double origin, double step, double index, double* out,
                      std::size_t n);
  /// out[i] = piece at u[i].
  void (*array)(const PieceTask&, const double* u, double* out, std::size_t n);
  void (*array_controls)(const PieceTask&, const ControlTask&, const double* u, double* out,
                         std::size_t n);
};

/// The kernels in use. [any]
const GridKernels& grid_kernels() KNOTWAVE_RT;

/// c[0] + c[1] t + ... by Horner.
inline double horner(const double* c, int degree, double t) KNOTWAVE_RT {
  double sum = c[degree];
  for (int k = degree - 1; k >= 0; --k) sum = sum * t + c[k];
  return sum;
}

inline double clamp_to_hull(double y, double low, double high) KNOTWAVE_RT {
  y = y < low ? low : y;
  return y > high ? high : y;
}

/// How far a control is moved from rest; NaN = not at all.
inline double control_move(double value, double rest, double low, double high) KNOTWAVE_RT {
  if (value != value) return 0.0;
  return clamp_to_hull(value, low, high) - rest;
}

/// The piece at u: what every kernel computes. `moves` [count] are control_move().
inline double sample_piece(const PieceTask& task, double u, const double* moves = nullptr,
                           int count = 0) KNOTWAVE_RT {
  const double t = ((u - task.shift) - task.start) * task.inverse_width;
  double y = horner(task.numerator, task.degree, t);
  for (int k = 0; k < count; ++k) {
    const std::size_t term = (static_cast<std::size_t>(k) + 1) * task.term_stride;
    y = y + moves[k] * horner(task.numerator + term, task.degree, t);
  }
  if (task.denominator != nullptr) {
    double d = horner(task.denominator, task.degree, t);
    for (int k = 0; k < count; ++k) {
      const std::size_t term = (static_cast<std::size_t>(k) + 1) * task.term_stride;
      d = d + moves[k] * horner(task.denominator + term, task.degree, t);
    }
    y = y / d;
  }
  return task.clamp ? clamp_to_hull(y, task.low, task.high) : y;
}

}  // namespace knotwave::curves
