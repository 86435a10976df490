// SPDX-License-Identifier: MIT
// The inner loops of elementary_block.h and of the filter's coefficients.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "knotwave/base/rt.h"
#include "knotwave/base/time.h"

namespace knotwave::dsp {

inline constexpr std::size_t kFilterChunk = 64;

/// The four numbers a sample of the filter is worked out with, for a chunk of samples.
struct FilterCoefficients {
  std::array<double, kFilterChunk> k, a1, a2, a3;
};

/// Cutoffs are limited to low_hz..high_hz; NaN counts as low_hz.
struct CutoffRange {
  double low_hz, high_hz;
  double half_cycles_per_hz;  ///< 1 / (2 rate)
};

/// Every vector unit gives the same bits. [audio]
struct ElementaryKernels {
  std::int64_t unit;  ///< the vector unit compiled for, as HWY_TARGET
  void (*exp2)(const double* in, double* out, std::size_t n);
  void (*db_to_gain)(const double* in, double* out, std::size_t n);
  void (*note_increments)(const double* notes, double rate_hz, base::Phase* out, std::size_t n);
  void (*phase_ramp)(base::Phase first, base::Phase increment, double origin, double width,
                     double* out, std::size_t n);
  /// a1, a2, a3 from k (n <= kFilterChunk of each) and the cutoffs: with g = tan(pi cutoff / rate)
  /// a1 = 1 / (1 + g (g + k)), a2 = g a1, a3 = g a2. Beyond n the three are left in any state.
  void (*filter)(const float* cutoff_hz, const CutoffRange& range, FilterCoefficients& to,
                 std::size_t n);
};

/// Those of the vector unit curves::simd_level() asks for. [audio]
const ElementaryKernels& elementary_kernels_in_use() KNOTWAVE_RT;

}  // namespace knotwave::dsp
