// SPDX-License-Identifier: MIT
// From the Fourier coefficients of rows to WaveTables. [control]
#pragma once
#include <array>
#include <functional>
#include <vector>

#include "knotwave/dsp/wave_tables.h"

namespace knotwave::dsp {

/// c[n] of one row, [channel][n].
using RowHarmonics = std::vector<std::vector<std::complex<double>>>;

class WaveTableBuilder {
 public:
  /// Errors: value_out_of_range, with the option at fault.
  static Result<WaveTableBuilder> create(int channels, const WaveTableOptions& options);

  /// Rows in order of position; each has `channels` lists of max_harmonic + 1 coefficients.
  void add_row(RowHarmonics row);
  int row_count() const { return rows_; }
  int max_harmonic() const { return options_.max_harmonic; }

  /// Blends of a polynomial B-spline: knots [rows + degree + 1], positions 0..1 over its domain.
  void blend_by_basis(std::span<const double> knots, int degree);
  /// Rows at equal distances, blended linearly.
  void blend_linearly();
  /// One stretch of positions from `start` to `end`: interpolation through kFitRows rows from row
  /// `first` at the places fit_node(k).
  void blend_by_interpolation(double start, double end, int first);
  static constexpr int kFitRows = 6;
  /// Chebyshev-Lobatto nodes on 0..1: 0, ..., 1.
  static double fit_node(int k);
  /// The weights of interpolation through the nodes at t in 0..1.
  static std::array<double, kFitRows> fit_weights(double t);

  void note_fit_error(double error);

  /// Ascending powers.
  using Polynomial = std::array<double, WaveTables::kMaxBlended>;

  /// Errors: value_out_of_range (more than kMaxTableBytes would be needed).
  Result<WaveTables> finish();
  static constexpr std::size_t kMaxTableBytes = std::size_t(1) << 29;

 private:
  explicit WaveTableBuilder(int channels, const WaveTableOptions& options);
  void add_blend(double start, WaveTables::BlendPiece piece, std::span<const Polynomial> weights);
  std::vector<double> strongest_by_harmonic() const;
  void plan_levels(std::span<const double> strongest, int harmonics);
  void fill_level(int level);

  WaveTableOptions options_;
  int rows_ = 0;
  WaveTables tables_;
};

/// Gives the row at a position 0..1.
using RowAt = std::function<Result<RowHarmonics>(double position)>;

/// Rows and blends so that every position is within max_error of row_at, re the peak: stretches
/// between `breaks` (positions, 0 first and 1 last) are halved until it is so. Errors:
/// error_bound_missed (more than 1024 rows), those of row_at.
Result<void> fit_rows(const RowAt& row_at, std::span<const double> breaks, double max_error,
                      WaveTableBuilder& builder);

}  // namespace knotwave::dsp
