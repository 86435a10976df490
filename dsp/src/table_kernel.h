// SPDX-License-Identifier: MIT
// The inner loops of the table oscillator: six taps of a uniform quintic B-spline.
#pragma once
#include <cstdint>
#include <span>

#include "knotwave/base/rt.h"
#include "knotwave/base/time.h"
#include "knotwave/dsp/wave_tables.h"

namespace knotwave::dsp {

/// One row of one channel of one level.
struct TableRow {
  const float* data;
  std::size_t row_step;  ///< floats to the same channel of the next row
  int size_log2;
};

/// Every pair of functions gives the bits of read_one(). [audio]
struct TableKernels {
  std::int64_t unit;  ///< the vector unit compiled for, as HWY_TARGET
  /// out[i] = the table at phases[i].
  void (*row)(const TableRow& row, std::span<const base::Phase> phases, float* out);
  /// The same with rows blended, by blends[i * step], step 0 or 1; `row` is row 0.
  void (*blended)(const TableRow& row, const WaveTables::RowBlend* blends, std::size_t step,
                  std::span<const base::Phase> phases, float* out);
};

/// Those of the vector unit curves::simd_level() asks for. [audio]
const TableKernels& table_kernels_in_use() KNOTWAVE_RT;

/// One sample. [audio]
float read_one(const TableRow& row, const WaveTables::RowBlend& blend,
               base::Phase phase) KNOTWAVE_RT;

}  // namespace knotwave::dsp
