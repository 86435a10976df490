// SPDX-License-Identifier: MIT
#include "wave_table_builder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "knotwave/base/elementary.h"
#include "knotwave/base/fp_state.h"
#include "knotwave/dsp/fft.h"

namespace knotwave::dsp {
namespace {

using Complex = std::complex<double>;

constexpr double kPi = 3.14159265358979323846;
/// Images of a table's harmonics stay below this, re the strongest harmonic: -130 dB.
constexpr double kImageFloor = 3.1622776601683794e-7;
/// The quintic basis in integers needs its coefficients over 120.
constexpr double kBasisScale = 1.0 / 120.0;

/// The whole part of 2^(k/3): one level each third of an octave, doubles left out.
std::vector<int> third_octaves_below(int harmonics) {
  // 2^(1/3) and 2^(2/3) in units of 2^-30, rounded down.
  constexpr std::int64_t kThirds[3] = {1 << 30, 1352829926, 1704458900};
  std::vector<int> grid;
  for (int octave = 0; octave < 16; ++octave) {
    for (const std::int64_t third : kThirds) {
      const int count = static_cast<int>((third << octave) >> 30);
      if (count >= harmonics) return grid;
      if (grid.empty() || count > grid.back()) grid.push_back(count);
    }
  }
  return grid;
}

/// Gain of the nearest image of harmonic n in a table of `size` coefficients.
double image_gain(double n, double size) {
  const double ratio = n / (size - n);
  const double cube = ratio * ratio * ratio;
  return cube * cube;
}

/// log2 of the smallest table whose images stay below the floor.
int table_size_log2(std::span<const double> strongest, int harmonics) {
  const double allowed = kImageFloor * *std::max_element(strongest.begin() + 1, strongest.end());
  const auto smallest = std::max<unsigned>(WaveTables::kMinTableSize,
                                           std::bit_ceil(4u * static_cast<unsigned>(harmonics)));
  const auto largest =
      std::max<unsigned>(smallest, std::bit_ceil(32u * static_cast<unsigned>(harmonics)));
  for (unsigned size = smallest;; size *= 2) {
    bool clean = true;
    for (int n = 1; n <= harmonics && clean; ++n) {
      clean = strongest[static_cast<std::size_t>(n)] * image_gain(n, size) <= allowed;
    }
    if (clean || size >= largest) return static_cast<int>(std::bit_width(size)) - 1;
  }
}

/// 1 / sinc^6(n / size): undoes the low-pass of the quintic basis exactly.
double prefilter(int n, int size) {
  if (n == 0) return 1;
  const double x = static_cast<double>(n) / size;
  const double inverse_sinc = kPi * x / base::sin_cos_cycles(0.5 * x).sin;
  const double cube = inverse_sinc * inverse_sinc * inverse_sinc;
  return cube * cube;
}

}  // namespace

Result<WaveTableBuilder> WaveTableBuilder::create(int channels, const WaveTableOptions& options) {
  if (options.max_harmonic < 1 || options.max_harmonic > kMaxHarmonic) {
    return fail(ErrorCode::value_out_of_range, "max_harmonic " +
                                                   std::to_string(options.max_harmonic) +
                                                   " is not in 1.." + std::to_string(kMaxHarmonic));
  }
  if (!(options.floor_db <= 0) || !(options.max_fit_error > 0)) {
    return fail(ErrorCode::value_out_of_range,
                "floor_db must not be above 0 and max_fit_error not be 0 or less");
  }
  return WaveTableBuilder(channels, options);
}

WaveTableBuilder::WaveTableBuilder(int channels, const WaveTableOptions& options)
    : options_(options) {
  tables_.channels_ = channels;
  tables_.coefficients_.clear();
  tables_.blends_.clear();
  tables_.blend_starts_.clear();
}

void WaveTableBuilder::add_row(RowHarmonics row) {
  KNOTWAVE_ASSERT(static_cast<int>(row.size()) == tables_.channels_);
  for (std::vector<Complex>& channel : row) {
    channel.resize(static_cast<std::size_t>(options_.max_harmonic) + 1);
    if (options_.remove_dc) channel[0] = 0;
    tables_.coefficients_.push_back(std::move(channel));
  }
  ++rows_;
}

void WaveTableBuilder::note_fit_error(double error) {
  tables_.fit_error_ = std::max(tables_.fit_error_, error);
}

std::vector<double> WaveTableBuilder::strongest_by_harmonic() const {
  std::vector<double> strongest(static_cast<std::size_t>(options_.max_harmonic) + 1, 0.0);
  for (const std::vector<Complex>& row : tables_.coefficients_) {
    for (std::size_t n = 1; n < strongest.size(); ++n) {
      const double square = row[n].real() * row[n].real() + row[n].imag() * row[n].imag();
      strongest[n] = std::max(strongest[n], std::sqrt(square));
    }
  }
  return strongest;
}

void WaveTableBuilder::plan_levels(std::span<const double> strongest, int harmonics) {
  std::vector<int> counts = third_octaves_below(harmonics);
  counts.push_back(harmonics);
  tables_.levels_.clear();
  std::size_t offset = 0;
  for (const int count : counts) {
    WaveTables::Level level;
    level.harmonics = count;
    level.size_log2 = table_size_log2(strongest, count);
    level.limit = (~std::uint64_t(0) >> 1) / static_cast<std::uint64_t>(count);
    level.offset = offset;
    offset += WaveTables::table_stride(level.size_log2) * tables_.coefficients_.size();
    tables_.levels_.push_back(level);
  }
  tables_.tables_.clear();
}

void WaveTableBuilder::fill_level(int level) {
  const WaveTables::Level& plan = tables_.levels_[static_cast<std::size_t>(level)];
  const int size = 1 << plan.size_log2;
  const std::size_t stride = WaveTables::table_stride(plan.size_log2);
  std::vector<double> gain(static_cast<std::size_t>(plan.harmonics) + 1);
  for (std::size_t n = 0; n < gain.size(); ++n) {
    gain[n] = kBasisScale * prefilter(static_cast<int>(n), size);
  }
  CycleSynthesis synthesis(static_cast<std::size_t>(size));
  std::vector<Complex> harmonics(gain.size());
  std::vector<double> cycle(static_cast<std::size_t>(size));
  for (std::size_t row = 0; row < tables_.coefficients_.size(); ++row) {
    for (std::size_t n = 0; n < gain.size(); ++n) {
      harmonics[n] = tables_.coefficients_[row][n] * gain[n];
    }
    synthesis.render(harmonics, cycle);
    float* out = tables_.tables_.data() + plan.offset + row * stride;
    const auto mask = static_cast<std::size_t>(size - 1);
    for (std::size_t k = 0; k < stride; ++k) {  // entry 0 is two before the cycle's start
      const double value = cycle[(k + mask - 1) & mask];
      out[k] = static_cast<float>(base::snap_to_zero(value));
    }
  }
}

Result<WaveTables> WaveTableBuilder::finish() {
  KNOTWAVE_ASSERT(rows_ >= 1 && !tables_.blends_.empty());
  tables_.rows_ = rows_;
  const std::vector<double> strongest = strongest_by_harmonic();
  const double allowed = base::db_to_gain(options_.floor_db) *
                         *std::max_element(strongest.begin() + 1, strongest.end());
  int harmonics = options_.max_harmonic;
  double left_out = 0;
  while (harmonics > 1) {
    left_out += strongest[static_cast<std::size_t>(harmonics)];
    if (left_out > allowed) break;
    --harmonics;
  }
  plan_levels(strongest, harmonics);
  for (std::vector<Complex>& row : tables_.coefficients_) {
    row.resize(static_cast<std::size_t>(harmonics) + 1);
  }
  const WaveTables::Level& last = tables_.levels_.back();
  const std::size_t size =
      last.offset + WaveTables::table_stride(last.size_log2) * tables_.coefficients_.size();
  if (size * sizeof(float) > kMaxTableBytes) {
    return fail(ErrorCode::value_out_of_range,
                "the waveform would need " + std::to_string(size * sizeof(float) >> 20) +
                    " MiB of tables, more than " + std::to_string(kMaxTableBytes >> 20) +
                    ": use fewer rows or a smaller max_harmonic");
  }
  tables_.tables_.resize(size);
  for (int level = 0; level < tables_.level_count(); ++level) fill_level(level);
  return std::move(tables_);
}

}  // namespace knotwave::dsp
