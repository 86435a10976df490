// SPDX-License-Identifier: MIT
// A checked, immutable NURBS surface (u, v) -> R^dim: a curve of curves. Control-side.
// Source: Piegl & Tiller, The NURBS Book, 2nd ed.: A3.5/A4.3 point, A3.6/A4.4 derivatives.
#pragma once
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

struct SpanBasis;

/// What a surface file says, before anyone has checked it.
struct SurfaceSpec {
  std::string name;
  int degree_u = 3;
  int degree_v = 3;
  int dim = 1;
  int count_u = 0;              ///< points in a row
  int count_v = 0;              ///< rows
  std::vector<double> points;   ///< [count_v*count_u*dim]: rows of u, one row a v
  std::vector<double> weights;  ///< [count_v*count_u] or empty
  std::vector<double> knots_u;  ///< as CurveSpec::knots
  std::vector<double> knots_v;
  bool periodic_u = false;  ///< rows are closed
};

class NurbsSurface {
 public:
  /// Errors as NurbsCurve::create, the message says which direction. [control]
  static Result<NurbsSurface> create(SurfaceSpec spec);

  const std::string& name() const noexcept { return name_; }
  int degree_u() const noexcept { return degree_u_; }
  int degree_v() const noexcept { return degree_v_; }
  int dim() const noexcept { return dim_; }
  bool is_rational() const noexcept { return rational_; }
  bool is_periodic_u() const noexcept { return periodic_u_; }
  /// Points in a row as evaluated (a periodic row has its first p again at the end), and rows.
  int count_u() const noexcept { return count_u_; }
  int count_v() const noexcept { return count_v_; }
  std::span<const double> points() const noexcept { return points_; }    ///< [count_v*count_u*dim]
  std::span<const double> weights() const noexcept { return weights_; }  ///< [count_v*count_u]
  std::span<const double> knots_u() const noexcept { return knots_u_; }
  std::span<const double> knots_v() const noexcept { return knots_v_; }
  double u_min() const noexcept { return knots_u_[static_cast<std::size_t>(degree_u_)]; }
  double u_max() const noexcept { return knots_u_[static_cast<std::size_t>(count_u_)]; }
  double v_min() const noexcept { return knots_v_[static_cast<std::size_t>(degree_v_)]; }
  double v_max() const noexcept { return knots_v_[static_cast<std::size_t>(count_v_)]; }
  SurfaceSpec spec() const;

  /// S(u, v) to out[dim]. [any] Parameters clamped (u wrapped if periodic); NaN counts as minimum.
  void evaluate(double u, double v, std::span<double> out) const noexcept;

  /// All partials d^(k+l)S / du^k dv^l with k + l <= order <= kMaxDegree, to
  /// out[(order+1)*(order+1)*dim] at index (k*(order+1)+l)*dim; the rest is set to 0. [any] Correct
  /// for weights (A4.4). At a knot each direction has its own side; without, those of the spans to
  /// the right, at the end of the domain to the left. One beyond all doubles is the largest with
  /// its sign, never NaN. O(order^2 (p + 1) (q + 1)) in double-double, rational ones O(order^4)
  /// more, no allocation.
  void derivatives(double u, double v, int order, std::span<double> out) const noexcept;
  void derivatives(double u, Side side_u, double v, Side side_v, int order,
                   std::span<double> out) const noexcept;

  /// The curve u -> S(u, v0) (exact). [control]
  NurbsCurve iso_curve_at_v(double v0) const;
  /// The curve v -> S(u0, v). [control]
  NurbsCurve iso_curve_at_u(double u0) const;

  friend bool operator==(const NurbsSurface&, const NurbsSurface&) = default;

 private:
  NurbsSurface() = default;
  /// Appends one control point of an iso curve: the blend of degree + 1 of ours.
  void append_blend(CurveSpec& spec, const SpanBasis& basis, int degree, int first,
                    int stride) const;
  std::string name_;
  int degree_u_ = 0, degree_v_ = 0, dim_ = 0, count_u_ = 0, count_v_ = 0;
  bool rational_ = false, periodic_u_ = false;
  std::vector<double> points_, weights_, knots_u_, knots_v_;
};

}  // namespace knotwave::curves
