// SPDX-License-Identifier: MIT
#include "knotwave/dsp/wave_tables.h"

#include <bit>

#include "table_kernel.h"

namespace knotwave::dsp {

WaveTables::WaveTables()
    : levels_(1),
      blends_(1),
      blend_starts_(1),
      tables_(table_stride(levels_[0].size_log2)),
      coefficients_(1, {0, 0}) {}

std::size_t WaveTables::memory_bytes() const noexcept {
  std::size_t bytes = tables_.size() * sizeof(float) + blends_.size() * sizeof(BlendPiece);
  for (const auto& row : coefficients_) bytes += row.size() * sizeof(row[0]);
  return bytes;
}

// Below bit width b of the increment, 2^(63 - b) harmonics fit and twice as many do not: the level
// of that power of two is the first guess and the right one is at most three further.
int WaveTables::level_for(base::Phase increment) const KNOTWAVE_RT {
  const std::uint64_t backwards = std::uint64_t(0) - increment.value;
  const std::uint64_t step = increment.value < backwards ? increment.value : backwards;
  const int last = level_count() - 1;
  if (step == 0) return last;
  const int octave = 63 - static_cast<int>(std::bit_width(step));
  if (octave < 0) return 0;
  // Levels 1 | 2 3 | 4 5 6 | 8 10 12 | ...
  int level = octave < 2 ? octave : 3 * octave - 3;
  if (level >= last) level = last;
  while (level < last && step <= levels_[static_cast<std::size_t>(level) + 1].limit) ++level;
  while (level > 0 && step > levels_[static_cast<std::size_t>(level)].limit) --level;
  return level;
}

namespace {

/// weight[r] = sum_k power[k][r] t^k for Rows rows: the rows are the lanes of a vector.
template <int Rows>
void weights_at(const double (&power)[WaveTables::kMaxBlended][WaveTables::kMaxBlended], int degree,
                double t, float* weight) KNOTWAVE_RT {
  double sum[Rows];
  for (int r = 0; r < Rows; ++r) sum[r] = power[degree][r];
  for (int k = degree - 1; k >= 0; --k) {
    for (int r = 0; r < Rows; ++r) sum[r] = sum[r] * t + power[k][r];
  }
  for (int r = 0; r < Rows; ++r) weight[r] = static_cast<float>(sum[r]);
}

}  // namespace

WaveTables::RowBlend WaveTables::blend_at(double position) const KNOTWAVE_RT {
  if (!(position > 0)) position = 0;
  if (position > 1) position = 1;
  std::size_t found = 0;  // the last piece that starts at or before position
  for (std::size_t left = blend_starts_.size(); left > 1;) {
    const std::size_t half = left / 2;
    found = blend_starts_[found + half] <= position ? found + half : found;
    left -= half;
  }
  const BlendPiece& piece = blends_[found];
  RowBlend blend;
  blend.first = piece.first;
  blend.count = piece.count;
  const double t = (position - blend_starts_[found]) * piece.inverse_width;
  if (piece.count <= 4) {
    weights_at<4>(piece.power, piece.degree, t, blend.weight);
  } else {
    weights_at<8>(piece.power, piece.degree, t, blend.weight);
  }
  return blend;
}

float WaveTables::read(int level, const RowBlend& blend, int channel,
                       base::Phase phase) const KNOTWAVE_RT {
  const LevelView view = level_view(level);
  return read_one({view.data + view.stride * static_cast<std::size_t>(channel),
                   view.stride * static_cast<std::size_t>(channels_), view.size_log2},
                  blend, phase);
}

std::span<const std::complex<double>> WaveTables::coefficients(int row, int channel) const {
  return coefficients_[static_cast<std::size_t>(row * channels_ + channel)];
}

}  // namespace knotwave::dsp
