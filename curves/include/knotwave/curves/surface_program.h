// SPDX-License-Identifier: MIT
// What the audio thread plays of a surface: polynomial cells, or quotients of two, in local
// parameters s, t in [0, 1]. Immutable.
// Source: tensor-product power basis (Piegl & Tiller, The NURBS Book, 2nd ed., 6.6), coefficients
// in double-double, each rounded once.
#pragma once
#include <span>
#include <vector>

#include "knotwave/base/rt.h"
#include "knotwave/curves/curve_program.h"
#include "knotwave/curves/nurbs_surface.h"

namespace knotwave::curves {

class SurfaceProgram {
 public:
  SurfaceProgram();  ///< the constant 0 on [0, 1] x [0, 1]

  int dim() const KNOTWAVE_RT { return dim_; }
  bool is_rational() const KNOTWAVE_RT { return rational_; }
  bool is_periodic_u() const KNOTWAVE_RT { return periodic_u_; }
  int degree_u() const KNOTWAVE_RT { return degree_u_; }
  int degree_v() const KNOTWAVE_RT { return degree_v_; }
  double u_min() const KNOTWAVE_RT { return breaks_u_.front(); }
  double u_max() const KNOTWAVE_RT { return breaks_u_.back(); }
  double v_min() const KNOTWAVE_RT { return breaks_v_.front(); }
  double v_max() const KNOTWAVE_RT { return breaks_v_.back(); }
  /// Where cells meet, [cells + 1], increasing.
  std::span<const double> breaks_u() const KNOTWAVE_RT { return breaks_u_; }
  std::span<const double> breaks_v() const KNOTWAVE_RT { return breaks_v_; }
  /// Bound of |program - surface|, in output units: nothing is fitted, this is rounding, bounded
  /// from the coefficients.
  double max_error() const noexcept { return max_error_; }
  /// The range the output never leaves: the hull of the control points.
  double low(int coordinate = 0) const KNOTWAVE_RT { return low_[std::size_t(coordinate)]; }
  double high(int coordinate = 0) const KNOTWAVE_RT { return high_[std::size_t(coordinate)]; }

  /// Value of one coordinate. [audio] Parameters clamped (u wrapped if periodic), NaN counts as the
  /// minimum. O(log cells + (p + 1)(q + 1)).
  double at(double u, double v, int coordinate = 0) const KNOTWAVE_RT;
  /// Its derivatives by u and by v, of the cell to the right (at the maximum: to the left). [audio]
  struct Slopes {
    double by_u = 0;
    double by_v = 0;
  };
  Slopes slopes_at(double u, double v, int coordinate = 0) const KNOTWAVE_RT;
  /// out[i] = at(u[i], v) to the bit: a row, for which each cell is made a polynomial of u once.
  /// [audio]
  void render_row(std::span<const double> u, double v, std::span<double> out,
                  int coordinate = 0) const KNOTWAVE_RT;
  /// out[i] = at(u[i], v[i]) to the bit: a path over the surface. [audio]
  void render_path(std::span<const double> u, std::span<const double> v, std::span<double> out,
                   int coordinate = 0) const KNOTWAVE_RT;

 private:
  friend class SurfaceCompiler;  // src/compile_surface.cpp
  struct Place;
  struct Row;  // a cell at one v: polynomials of s
  Place place_u(double u, int near = 0) const KNOTWAVE_RT;
  Place place_v(double v, int near = 0) const KNOTWAVE_RT;
  Row row_at(int cell_u, const Place& v, int coordinate) const KNOTWAVE_RT;
  const double* coefficients(int cell_u, int cell_v, int row) const KNOTWAVE_RT;
  double clamped(double value, int coordinate) const KNOTWAVE_RT;

  // Layout: coefficients_[(((cell_v * cells_u + cell_u) * (dim + rational) + row) * (degree_u + 1)
  // + power of s) * (degree_v + 1) + power of t]; row dim is the denominator.
  int dim_ = 1;
  int degree_u_ = 0, degree_v_ = 0;
  bool rational_ = false, periodic_u_ = false;
  double max_error_ = 0;
  std::vector<double> breaks_u_, breaks_v_;
  std::vector<double> inverse_widths_u_, inverse_widths_v_;
  std::vector<double> coefficients_;
  std::vector<double> low_, high_;
};

/// [control] Errors: degree_out_of_range (above kMaxPieceDegree in a direction).
Result<SurfaceProgram> compile_surface(const NurbsSurface& surface);

}  // namespace knotwave::curves
