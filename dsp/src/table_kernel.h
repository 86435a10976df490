// SPDX-License-Identifier: MIT
// The inner loop of the table oscillator: six taps of a uniform quintic B-spline. Samples lie in
// the lanes of 128-bit vectors, which every processor we run on has, so there is one kernel and no
// dispatch; each lane does what read_one() does, in its order, and gives its bits.
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

/// out[i] = the table at phases[i]. [audio]
void read_row(TableRow row, std::span<const base::Phase> phases, float* out) KNOTWAVE_RT;

/// The same with rows blended; blends[i * blend_step], blend_step 0 or 1. `row` is row 0. [audio]
void read_blended(TableRow row, const WaveTables::RowBlend* blends, int blend_step,
                  std::span<const base::Phase> phases, float* out) KNOTWAVE_RT;

/// One sample in plain C++. [audio]
float read_one(TableRow row, const WaveTables::RowBlend& blend, base::Phase phase) KNOTWAVE_RT;

}  // namespace knotwave::dsp
