// SPDX-License-Identifier: MIT
// A checked, immutable NURBS function of one parameter, u -> R^dim. A value: copy it, compare it.
// Control-side type: double precision, owns heap memory. The audio thread plays curve_program.h.
// Source: Piegl & Tiller, The NURBS Book, 2nd ed.: A2.1 span, A3.1/A4.1 point, A2.3/A4.2
// derivatives.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "knotwave/base/result.h"

namespace knotwave::curves {

inline constexpr int kMaxDegree = 15;
inline constexpr int kMaxDim = 4;
inline constexpr int kMaxPoints = 4096;
inline constexpr double kMinWeight = 1e-6;
inline constexpr double kMaxWeight = 1e6;
inline constexpr double kMaxCoordinate = 1e6;
inline constexpr double kMaxKnot = 1e9;         ///< largest magnitude
inline constexpr double kMinKnotStep = 1e-280;  ///< between knots that differ

/// What a curve file says, before anyone has checked it.
struct CurveSpec {
  std::string name;             ///< used in error messages
  int degree = 3;               ///< polynomial degree p, 1..kMaxDegree (order = p + 1)
  int dim = 1;                  ///< numbers per control point, 1..kMaxDim
  std::vector<double> points;   ///< [n*dim], not pre-weighted
  std::vector<double> weights;  ///< [n], each in kMinWeight..kMaxWeight; empty = all 1
  std::vector<double> knots;    ///< [n+p+1], periodic [n+1]; empty = clamped uniform on [0, 1]
                                ///< (periodic: uniform on [0, 1])
  bool periodic = false;        ///< each point listed once, wrapped by create()
  std::vector<double> jumps;    ///< inner knots that may have multiplicity p + 1
};

/// Which limit at a knot: the value of the span to its left or to its right.
enum class Side { left, right };

class NurbsCurve {
 public:
  /// Checks `spec` and keeps it. [control]
  /// Errors: degree_out_of_range, too_few_points (n < p + 1; periodic: n < p + 1),
  /// too_many_points, dimension_mismatch, knot_count_mismatch, knots_decrease, knot_multiplicity
  /// (an inner knot more than p times and not in `jumps`, or any more than p + 1 times; a periodic
  /// knot more than p times), empty_domain, weight_count_mismatch, weight_out_of_range,
  /// weight_not_positive, coordinate_out_of_range, value_out_of_range (a knot beyond kMaxKnot, or
  /// above the one before it by less than kMinKnotStep), parameter_out_of_range (a jump that is no
  /// inner knot), not_finite. The message names the curve, the index at fault and both numbers.
  static Result<NurbsCurve> create(CurveSpec spec);

  const std::string& name() const noexcept { return name_; }
  int degree() const noexcept { return degree_; }
  int dim() const noexcept { return dim_; }
  bool is_rational() const noexcept { return rational_; }
  bool is_periodic() const noexcept { return periodic_; }
  /// First and last knot of the domain have multiplicity p + 1 (the curve ends at its end points).
  bool is_clamped() const noexcept;
  double u_min() const noexcept { return knots_[static_cast<std::size_t>(degree_)]; }
  double u_max() const noexcept { return knots_[static_cast<std::size_t>(point_count())]; }

  /// Points as evaluated: a periodic curve has its first p points again at the end. n here. Its
  /// knots go on to both sides, shifted by the period; rounded here, exact in evaluation and edits.
  int point_count() const noexcept { return static_cast<int>(weights_.size()); }
  std::span<const double> points() const noexcept { return points_; }    ///< [n*dim]
  std::span<const double> weights() const noexcept { return weights_; }  ///< [n], 1 without
  std::span<const double> knots() const noexcept { return knots_; }      ///< [n+p+1]
  std::span<const double> jumps() const noexcept { return jumps_; }

  /// The same curve as a spec again; create() of it gives an equal curve. Periodic points once.
  CurveSpec spec() const;

  /// C(u) to out[dim]. [any] u is clamped to the domain (wrapped if periodic), NaN counts as u_min.
  /// At a jump the right-hand value; at u_max the left-hand one. A clamped curve returns its end
  /// points exactly. The exact value rounded: within half an ulp of max|P|, so never outside the
  /// range of its control points. Here and in all that is said of ulps elsewhere, one counts as
  /// 2^-1000 at least: below, doubles have no bits to spare. O(p^2) in double-double, no
  /// allocation.
  void evaluate(double u, std::span<double> out) const noexcept;
  void evaluate(double u, Side side, std::span<double> out) const noexcept;

  /// C and its first `order` derivatives by u to out[(order+1)*dim], value first. [any] Correct
  /// for weights (A4.2); order may exceed the degree. A derivative beyond all doubles (order 136 of
  /// some, order 2 on a span of 1e-200) is the largest double with its sign, never NaN. Not by
  /// time: multiply by du/dt yourself.
  void derivatives(double u, int order, Side side, std::span<double> out) const noexcept;

  friend bool operator==(const NurbsCurve&, const NurbsCurve&) = default;

 private:
  NurbsCurve() = default;
  std::string name_;
  int degree_ = 0;
  int dim_ = 0;
  bool rational_ = false;
  bool periodic_ = false;
  std::vector<double> points_;
  std::vector<double> weights_;
  std::vector<double> knots_;
  std::vector<double> jumps_;
};

/// Index i of the span with knots[i] <= u < knots[i+1] (A2.1); the last span is closed, Side::left
/// takes knots[i] < u <= knots[i+1]. Always a span of positive length, degree <= i <= n - 1. [any]
/// knots [n+p+1]. O(log n).
int find_span(std::span<const double> knots, int degree, double u, Side side) noexcept;

/// The p + 1 basis functions that are not 0 on span `span` at u, to out[p+1] (A2.2). [any]
void basis_functions(std::span<const double> knots, int degree, int span, double u,
                     std::span<double> out) noexcept;

}  // namespace knotwave::curves
