// SPDX-License-Identifier: MIT
// A closed curve as band-limited tables: exact Fourier coefficients, cut per third-octave level,
// written back as a uniform quintic B-spline with the exact prefilter 1 / sinc^6. Passband error 0.
// Engine A of docs/alias-free.md.
#pragma once
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/base/rt.h"
#include "knotwave/base/time.h"
#include "knotwave/curves/compile.h"
#include "knotwave/curves/nurbs_surface.h"

namespace knotwave::dsp {

inline constexpr int kMaxHarmonic = 16384;

struct WaveTableOptions {
  int max_harmonic = 2048;  ///< 1..kMaxHarmonic; 2048 reach 24 kHz from 11.7 Hz
  double floor_db = -150;   ///< harmonics whose sum is below this, re the strongest, are left out
  bool remove_dc = true;    ///< a waveform's mean is not sound
  double max_fit_error = 1e-6;  ///< rational rows: largest error asked for, re the peak
};

/// Exact c[n], n = 0..max_harmonic, of one cycle of a polynomial program (compile_polynomial) at
/// rest: y(t) = c[0] + sum_n c[n] e^{2 pi i n t} + conj, t = 0..1 over the domain. End-point sums
/// of every derivative per piece, Gauss-Legendre where a piece is short against the period.
/// [control] Error below -200 dB re max|y|. O(pieces * max_harmonic). The program must not be
/// rational.
std::vector<std::complex<double>> fourier_coefficients(const curves::CurveProgram& cycle,
                                                       int coordinate, int max_harmonic);

/// Immutable. Rows are places along v (1 for a curve), channels are 1 or 2 (left and right).
/// Level 0 holds the fundamental alone, the last level every harmonic worth keeping.
class WaveTables {
 public:
  static constexpr int kTaps = 6;        ///< quintic
  static constexpr int kMaxBlended = 8;  ///< rows that sound together: degree along v + 1
  static constexpr int kMinTableSize = 64;
  static constexpr int kMaxRows = 4096;

  WaveTables();  ///< silence

  /// A curve of 1 or 2 coordinates as one cycle over its domain; open curves are closed by a jump.
  /// [control] Errors: not_scalar (dim > 2), value_out_of_range (options), and those of
  /// compile_polynomial.
  static Result<WaveTables> create(const curves::NurbsCurve& curve,
                                   const WaveTableOptions& options = {});
  /// Rows band-limited in u and blended with the v basis: no stepping. Rational surfaces, and
  /// degrees along v above 7, are fitted along v with the error printed in fit_error(). Errors: as
  /// above, error_bound_missed.
  static Result<WaveTables> create(const curves::NurbsSurface& surface,
                                   const WaveTableOptions& options = {});
  /// A curve with one declared control becomes a surface over the control's range; position 0..1
  /// runs from low to high. A moved coordinate is exact, a moved weight is fitted. Errors: as
  /// above, value_out_of_range (no such point or range).
  static Result<WaveTables> create(const curves::NurbsCurve& curve,
                                   const curves::ControlRange& control,
                                   const WaveTableOptions& options = {});
  /// Sampled single cycles, rows after one another [rows*frame], blended linearly; any frame length
  /// >= 2. Errors: too_few_points, too_many_points, dimension_mismatch, not_finite,
  /// value_out_of_range.
  static Result<WaveTables> create_from_cycles(std::span<const float> samples, int frame, int rows,
                                               const WaveTableOptions& options = {});
  /// One row of harmonics c[0], c[1], ... as in fourier_coefficients; a sine is {0, -0.5i}. Errors:
  /// too_few_points (none), not_finite, value_out_of_range.
  static Result<WaveTables> create_from_harmonics(std::span<const std::complex<double>> harmonics,
                                                  const WaveTableOptions& options = {});

  int channels() const KNOTWAVE_RT { return channels_; }
  int rows() const KNOTWAVE_RT { return rows_; }
  int level_count() const KNOTWAVE_RT { return static_cast<int>(levels_.size()); }
  int level_harmonics(int level) const KNOTWAVE_RT { return levels_[std::size_t(level)].harmonics; }
  /// Spline coefficients in a cycle of the level, a power of two >= kMinTableSize.
  int level_size(int level) const KNOTWAVE_RT { return 1 << levels_[std::size_t(level)].size_log2; }
  /// Largest error found of what was fitted, re the peak: rows blended between the places that were
  /// compiled, and polynomials for rational spans. Rounding where nothing was fitted.
  double fit_error() const noexcept { return fit_error_; }
  std::size_t memory_bytes() const noexcept;

  /// The richest level whose harmonics all stay below half the sample rate; level 0 if none does.
  /// Increments above half a cycle count as negative. [audio] O(1), integer.
  int level_for(base::Phase increment) const KNOTWAVE_RT;

  /// Weights of the rows at position v in 0..1 (clamped, NaN = 0): `count` rows from `first`.
  struct RowBlend {
    int first = 0;
    int count = 1;
    float weight[kMaxBlended] = {1, 0, 0, 0, 0, 0, 0, 0};
  };
  RowBlend blend_at(double position) const KNOTWAVE_RT;

  /// Largest |increment| at which the level's harmonics stay below half the sample rate. [audio]
  std::uint64_t level_limit(int level) const KNOTWAVE_RT {
    return levels_[std::size_t(level)].limit;
  }

  /// One sample. [audio] The reference of the oscillator's kernel, equal to it bit for bit.
  float read(int level, const RowBlend& blend, int channel, base::Phase phase) const KNOTWAVE_RT;

  /// Coefficients of one level for a reader: those of row r and channel c begin at
  /// data + (r * channels + c) * stride; entry k is coefficient k - 2 (wrapped), over 120. [audio]
  struct LevelView {
    const float* data = nullptr;
    std::size_t stride = 0;
    int size_log2 = 6;
  };
  LevelView level_view(int level) const KNOTWAVE_RT {
    const Level& found = levels_[std::size_t(level)];
    return {tables_.data() + found.offset, table_stride(found.size_log2), found.size_log2};
  }

  /// Fourier coefficients of a row and channel as kept, for tests and plots. [control]
  std::span<const std::complex<double>> coefficients(int row, int channel) const;

 private:
  friend class WaveTableBuilder;  // src/wave_table_builder.h
  struct Level {
    int harmonics = 1;
    int size_log2 = 6;
    std::uint64_t limit =
        ~std::uint64_t(0) >> 1;  ///< largest increment that keeps it below Nyquist
    std::size_t offset = 0;      ///< of row 0, channel 0 in tables_
  };
  /// Weights over a stretch of positions: polynomials in
  /// (position - start) * inverse_width.
  struct BlendPiece {
    double inverse_width = 1;
    int first = 0;
    int count = 1;
    int degree = 0;
    double power[kMaxBlended][kMaxBlended] = {{1}};  ///< [power][row]
  };
  static constexpr std::size_t table_stride(int size_log2) KNOTWAVE_RT {
    return (std::size_t(1) << size_log2) + 8;
  }

  int channels_ = 1;
  int rows_ = 1;
  double fit_error_ = 0;
  std::vector<Level> levels_;
  std::vector<BlendPiece> blends_;
  std::vector<double> blend_starts_;  ///< of each, increasing
  std::vector<float> tables_;
  std::vector<std::vector<std::complex<double>>> coefficients_;  ///< [row * channels + channel]
};

}  // namespace knotwave::dsp
