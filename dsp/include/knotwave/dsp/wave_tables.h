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

struct WaveTableOptions {
  int max_harmonic = 2048;  ///< 24 kHz at 11.7 Hz
  double floor_db = -150;   ///< harmonics whose sum is below this, re peak 1, are left out
  bool remove_dc = true;    ///< a waveform's mean is not sound
};

/// Exact c[n], n = 0..max_harmonic, of one cycle of a polynomial program (compile_polynomial):
/// end-point sums of every derivative per piece, Gauss-Legendre where a piece is short against the
/// period. [control] Error below -200 dB re max|y|.
std::vector<std::complex<double>> fourier_coefficients(const curves::CurveProgram& cycle,
                                                       int coordinate, int max_harmonic);

/// Immutable. Rows are places along v (1 for a curve), channels are 1 or 2 (left and right).
class WaveTables {
 public:
  static constexpr int kTaps = 6;  ///< quintic

  /// A curve of 1 or 2 coordinates as one cycle over its domain; open curves are closed by a jump.
  /// [control] Errors: not_scalar (dim > 2), and those of compile_polynomial.
  static Result<WaveTables> create(const curves::NurbsCurve& curve,
                                   const WaveTableOptions& options = {});
  /// Rows band-limited in u and blended with the v basis: no stepping. Rational surfaces are fitted
  /// along v with the error printed in fit_error(). Errors: as above, error_bound_missed.
  static Result<WaveTables> create(const curves::NurbsSurface& surface,
                                   const WaveTableOptions& options = {});
  /// A curve with one declared control becomes a surface over the control's range; position 0..1
  /// runs from low to high. Errors: as above, control_conflict.
  static Result<WaveTables> create(const curves::NurbsCurve& curve,
                                   const curves::ControlRange& control,
                                   const WaveTableOptions& options = {});
  /// Sampled single cycles, rows after one another [rows*frame]; any frame length >= 2.
  static Result<WaveTables> create_from_cycles(std::span<const float> samples, int frame, int rows,
                                               const WaveTableOptions& options = {});

  int channels() const KNOTWAVE_RT { return channels_; }
  int rows() const KNOTWAVE_RT { return rows_; }
  int level_count() const KNOTWAVE_RT { return static_cast<int>(levels_.size()); }
  int level_harmonics(int level) const KNOTWAVE_RT;
  double fit_error() const noexcept { return fit_error_; }
  std::size_t memory_bytes() const noexcept;

  /// The richest level whose harmonics all stay below half the sample rate. [audio] O(1).
  int level_for(base::Phase increment) const KNOTWAVE_RT;

  /// Weights of the rows at position v in 0..1 (clamped, NaN = 0): first row and up to 6 weights.
  struct RowBlend {
    int first = 0;
    int count = 1;
    float weight[8] = {1, 0, 0, 0, 0, 0, 0, 0};
  };
  RowBlend blend_at(double position) const KNOTWAVE_RT;

  /// One sample. [audio]
  float read(int level, const RowBlend& blend, int channel, base::Phase phase) const KNOTWAVE_RT;

  /// Fourier coefficients of a row and channel, for tests and plots. [control]
  std::span<const std::complex<double>> coefficients(int row, int channel) const;

 private:
  struct Level {
    int harmonics = 1;
    int size = 64;           ///< spline coefficients in a cycle
    std::size_t offset = 0;  ///< of row 0, channel 0 in tables_; each has size + kTaps - 1 floats
  };
  int channels_ = 1, rows_ = 1, degree_v_ = 0;
  double fit_error_ = 0;
  std::vector<Level> levels_;
  std::vector<double> knots_v_;
  std::vector<float> tables_;
  std::vector<std::vector<std::complex<double>>> coefficients_;
};

}  // namespace knotwave::dsp
