// SPDX-License-Identifier: MIT
// What the audio thread plays: explicit polynomial pieces, or quotients of two, in a local
// parameter t in [0, 1]. Immutable, made by compile.h; copying is cheap to reason about but
// allocates, so it is [control].
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "knotwave/base/rt.h"
#include "knotwave/curves/map_grid.h"

namespace knotwave::curves {

inline constexpr int kMaxPieceDegree = 7;
inline constexpr int kMaxControls = 8;

class LiveSpline;  // src/live_spline.h

/// The piece last used. Only a hint: any value gives the same samples. One per voice and program.
struct CurveCursor {
  int piece = 0;
};

class CurveProgram {
 public:
  CurveProgram();  ///< the constant 0 on [0, 1]

  int dim() const KNOTWAVE_RT { return dim_; }
  int piece_count() const KNOTWAVE_RT { return static_cast<int>(breaks_.size()) - 1; }
  int piece_degree() const KNOTWAVE_RT { return degree_; }
  bool is_rational() const KNOTWAVE_RT { return rational_; }
  bool is_periodic() const KNOTWAVE_RT { return periodic_; }
  double u_min() const KNOTWAVE_RT { return breaks_.front(); }
  double u_max() const KNOTWAVE_RT { return breaks_.back(); }
  /// Where pieces meet, [piece_count + 1], increasing.
  std::span<const double> breaks() const KNOTWAVE_RT { return breaks_; }
  /// 1 / (width of a piece), [piece_count].
  std::span<const double> inverse_widths() const KNOTWAVE_RT { return inverse_widths_; }
  /// |program - curve| is nowhere above this, in output units: proved, rounding included, at every
  /// double of the domain; of fitted pieces as a rule within 4 % of the largest error there is. One
  /// period of periodic programs: further out, u is rounded. With controls it is measured, not
  /// proved: twice the largest error found with none moved and at the corners of their ranges.
  double max_error() const noexcept { return max_error_; }
  int control_count() const KNOTWAVE_RT { return static_cast<int>(control_rest_.size()); }
  /// Control k when nothing moves it: the value written in the file. And its declared range.
  double control_rest(int k) const KNOTWAVE_RT { return control_rest_[std::size_t(k)]; }
  double control_low(int k) const KNOTWAVE_RT { return control_low_[std::size_t(k)]; }
  double control_high(int k) const KNOTWAVE_RT { return control_high_[std::size_t(k)]; }
  /// A control is a knot. With controls given, values and slopes then come from the points and
  /// knots by de Boor's algorithm, sample by sample; breaks() and coefficients() are those at rest.
  bool moves_knots() const KNOTWAVE_RT { return live_ != nullptr; }
  /// The range the output never leaves: the hull of the control points over all controls.
  double low(int coordinate = 0) const KNOTWAVE_RT { return low_[std::size_t(coordinate)]; }
  double high(int coordinate = 0) const KNOTWAVE_RT { return high_[std::size_t(coordinate)]; }

  /// Coefficients of one coordinate on a piece with controls at rest, lowest power of
  /// t = (u - breaks[piece]) / width first, [piece_degree + 1]. [any] Coordinate dim() of a
  /// rational program is the denominator, the others are then numerators.
  std::span<const double> coefficients(int piece, int coordinate = 0) const KNOTWAVE_RT;

  /// Value of one coordinate at u. [audio] u is clamped to the domain (wrapped if periodic), NaN
  /// counts as u_min. At an inner break with a jump, the right-hand value. `controls`
  /// [control_count] or empty for rest values; each clamped to its range, NaN = rest.
  double at_u(double u, int coordinate = 0,
              std::span<const double> controls = {}) const KNOTWAVE_RT;
  /// Derivative by u, right-hand (left-hand at u_max). [audio]
  double slope_at_u(double u, int coordinate = 0,
                    std::span<const double> controls = {}) const KNOTWAVE_RT;

  /// out[i] = at_u(run.at(i)) to the bit. [audio] Cost well under 1 ns a sample for long spans.
  void render(const GridRun& run, std::span<double> out, CurveCursor& cursor,
              int coordinate = 0) const KNOTWAVE_RT;
  void render(const GridRun& run, std::span<float> out, CurveCursor& cursor,
              int coordinate = 0) const KNOTWAVE_RT;
  /// out[i] = at_u(u[i]) to the bit: any parameters, in any order. [audio]
  void render(std::span<const double> u, std::span<double> out, CurveCursor& cursor,
              int coordinate = 0) const KNOTWAVE_RT;
  /// The same with controls that move every sample: controls[k][i], k < control_count. [audio]
  void render(std::span<const double> u, std::span<const double* const> controls,
              std::span<double> out, CurveCursor& cursor, int coordinate = 0) const KNOTWAVE_RT;

  /// out[i] = at_u(grid.at(first + i)) to the bit, the ends exact. [any]
  void evaluate_grid(const MapGrid& grid, std::int64_t first,
                     std::span<float> out) const KNOTWAVE_RT;

 private:
  friend class ProgramBuilder;  // src/program_builder.h, what compile() fills it with
  friend class PieceWalk;       // src/piece_walk.h, u to pieces

  std::size_t rows() const KNOTWAVE_RT { return std::size_t(dim_) + (rational_ ? 1U : 0U); }

  // Layout: coefficients_[((piece * (1 + controls) + term) * (dim + rational) + row) * (degree+1)
  // + power]; row dim is the denominator. Term 0 is the rest curve, term k + 1 what control k adds
  // for each unit it is moved from rest: (N0 + sum m_k N_k) / (D0 + sum m_k D_k).
  int dim_ = 1;
  int degree_ = 0;
  bool rational_ = false;
  bool periodic_ = false;
  double max_error_ = 0;
  double inverse_period_ = 1;
  std::size_t piece_size_ = 1;  // coefficients of a piece
  std::vector<double> breaks_;
  std::vector<double> inverse_widths_;
  std::vector<double> coefficients_;
  std::vector<unsigned char> inside_hull_;  // [piece * dim + coordinate]: needs no clamping
  // Value at u_min and u_max, [term * dim + coordinate]; empty where the pieces say it (the ends
  // of unclamped and periodic curves).
  std::vector<double> start_values_, end_values_;
  std::vector<double> low_, high_;
  std::vector<double> control_rest_, control_low_, control_high_;
  std::shared_ptr<const LiveSpline> live_;  // only where knots move
};

}  // namespace knotwave::curves
