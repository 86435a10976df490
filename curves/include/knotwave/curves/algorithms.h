// SPDX-License-Identifier: MIT
// Edits that do not change the curve: exact in the reals, within 4 ulp of max|P| in double. Both
// limits at every knot and jump are kept; tests/curves/one_sided_test.cpp.
// Source: Piegl & Tiller, The NURBS Book, 2nd ed.: A1.5 (de Casteljau), 3.2 (convex hull), A5.1
// (Boehm's insertion), 5.2 and 5.3 (splitting, refinement), A5.6 (decomposition), 5.5 (elevation,
// here by blossoms: src/spline_product.h); de Boor, A Practical Guide to Splines, X and XI
// (evaluation, knot averages).
#pragma once
#include <span>
#include <vector>

#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

/// One span as a rational Bézier segment over [u0, u1].
struct BezierSegment {
  double u0 = 0;
  double u1 = 1;
  int degree = 0;
  int dim = 0;
  std::vector<double> points;   ///< [(degree+1)*dim], not pre-weighted
  std::vector<double> weights;  ///< [degree+1]
};

/// Inserts knot u `times` times (Boehm; A5.1); periodic stays periodic. [control] Errors:
/// parameter_out_of_range (not inside the domain; an end only if unclamped), knot_multiplicity
/// (more than p), too_many_points, value_out_of_range (nearer another knot than kMinKnotStep).
Result<NurbsCurve> insert_knot(const NurbsCurve& curve, double u, int times = 1);

/// Inserts all of `knots`, in any order, repeated ones as often as they are there; rounded once,
/// however many. [control] Errors: those of insert_knot(), of which nothing is then inserted. A
/// jump keeps its multiplicity. O(m n) for m knots.
Result<NurbsCurve> refine(const NurbsCurve& curve, std::span<const double> knots);

/// The part over [u_a, u_b], clamped at both ends. [control] Errors: parameter_out_of_range,
/// empty_domain. At a jump the part takes the side that lies inside it.
Result<NurbsCurve> sub_curve(const NurbsCurve& curve, double u_a, double u_b);

struct CurvePair {
  NurbsCurve left;
  NurbsCurve right;
};
/// Both parts at u. [control] Errors: parameter_out_of_range (u not strictly inside).
Result<CurvePair> split(const NurbsCurve& curve, double u);

/// Bézier segments in order, one a span of positive length (A5.6). [control]
std::vector<BezierSegment> to_bezier(const NurbsCurve& curve);

/// de Casteljau: value of a rational Bézier segment at u, clamped to [u0, u1], to out[dim]. [any]
void de_casteljau(const BezierSegment& segment, double u, std::span<double> out) noexcept;

/// de Boor in homogeneous coordinates: an evaluation independent of NurbsCurve::evaluate. [any]
void de_boor(const NurbsCurve& curve, double u, std::span<double> out) noexcept;

/// Degree p + times, same curve, rounded once; an unclamped one becomes clamped, a periodic one
/// stays periodic. Knots of multiplicity m have m + times, jumps stay. [control] Errors:
/// degree_out_of_range, too_many_points, value_out_of_range (times < 0).
Result<NurbsCurve> elevate_degree(const NurbsCurve& curve, int times = 1);

/// Greville abscissae [point_count()], never wrapped: the u where each point pulls most. [control]
std::vector<double> greville_abscissae(const NurbsCurve& curve);

/// Least and greatest control point in one coordinate: the curve never leaves them. [control]
struct HullRange {
  double low = 0;
  double high = 0;
};
HullRange hull_range(const NurbsCurve& curve, int coordinate = 0);

/// Whether coordinate `coordinate` never decreases: decided by the Bernstein coefficients of its
/// derivative, subdividing spans of mixed sign until certain; a fall of less than 2^-44 max|P| is
/// rounding. [control]
bool is_non_decreasing(const NurbsCurve& curve, int coordinate = 0);

}  // namespace knotwave::curves
