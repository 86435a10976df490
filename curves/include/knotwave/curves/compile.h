// SPDX-License-Identifier: MIT
// Curves to what the audio thread plays, with an error they state. [control] throughout.
#pragma once
#include <vector>

#include "knotwave/curves/curve_program.h"
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

/// Something a controller may move while the curve plays, with its range.
struct ControlRange {
  enum class Kind { weight, coordinate, knot };
  Kind kind = Kind::weight;
  int point = 0;       ///< index as in the file, from 0; Kind::knot: of the knot
  int coordinate = 0;  ///< for Kind::coordinate
  double low = 0;      ///< absolute values: the weight, coordinate or knot itself
  double high = 1;
};

struct CompileOptions {
  double max_error = 1e-7;  ///< largest |program - curve| asked for, in output units (-140 dBFS)
  int max_pieces = 4096;    ///< more is an error (error_bound_missed), never a silent coarsening
  std::vector<ControlRange> controls;
};

/// Checks each control against the curve, the limits of curve files and the other controls. A knot
/// has to be a simple inner one, and its range to stay 1e-9 of the domain away from both
/// neighbours, wherever these are moved to. Errors: value_out_of_range, control_conflict.
Result<void> check_controls(const NurbsCurve& curve, const std::vector<ControlRange>& controls);

/// The curve with control k at values[k].
Result<NurbsCurve> curve_with(const NurbsCurve& curve, const std::vector<ControlRange>& controls,
                              const std::vector<double>& values);

/// A curve as a function. dim 1: u is the parameter, degree <= 7 stays exact (spans are cut where
/// rounding would be above max_error), above that pieces of degree 7 are fitted, their error
/// proved; they meet in value and, to rounding, in slope. dim 2: x is the parameter (time) and y
/// the value, the inversion is baked into explicit pieces (u_min = x at the start). Vertical
/// tangents are allowed and meet max_error at every double, to whatever order time stands still.
/// Where x stands still for a while y jumps; where it goes back by less than 2^-44 of the largest
/// |x|, which counts as rounding, y is that of one of the places where time is x. docs/compile.md
/// has the method. Errors: not_a_function (x goes back further: the message gives the interval of
/// u), not_scalar (dim > 2), error_bound_missed, control_conflict (point and weight of the same
/// index, or two controls for the same number), value_out_of_range (a control's range leaves the
/// limits of curve files or leaves out the value written there), empty_domain (2-D: x never moves),
/// unsupported (controls on a 2-D curve or on degree > 7).
Result<CurveProgram> compile_function(const NurbsCurve& curve, const CompileOptions& options = {});

/// Every coordinate as a function of u (waveforms, orbits, arcs). Errors as above but
/// not_a_function and not_scalar.
Result<CurveProgram> compile_parametric(const NurbsCurve& curve,
                                        const CompileOptions& options = {});

/// The polynomial form: like compile_parametric, but rational spans become polynomial pieces within
/// max_error as well. For Fourier coefficients and antiderivatives.
Result<CurveProgram> compile_polynomial(const NurbsCurve& curve,
                                        const CompileOptions& options = {});

/// What it takes to start a section of a curve from any value and slope, as programs: B0 moves the
/// first control point P0 and those that follow it, B1 the second, P1. A join at value y0 and slope
/// s plays
///   program(u) + dp0 * basis0(u) + dp1 * basis1(u),
/// which begins at y0 with slope s and, from u_basis_end on (p spans later at most, 2 of degree 1),
/// is the program to the bit (both bases are exactly 0 there). P2 .. P(p-2) follow P0 by a share:
/// all of its step if level with it, nothing at the hull's edges, so that a join is no rougher than
/// the curve is drawn and no point leaves the hull. docs/compile.md, Joins.
struct JoinProgram {
  double u_join = 0;
  CurveProgram basis;  ///< dim 2: basis0, basis1, over [u_join, u_end]
  /// From here on both are 0. Of degree 1 in the last span basis 1 is 1 at the end, but P1 is never
  /// moved there.
  double u_basis_end = 0;
  double p0 = 0, p1 = 0;     ///< first two control points of the section
  double slope_factor = 1;   ///< slope at u_join by u = slope_factor * (p1 - p0); 0: see moves_p1
  double low = 0, high = 1;  ///< hull that p1 is limited to
  /// False for degree 1, where P1 is a corner; for degree 2, where the slope at the other end hangs
  /// on P1 as well (it follows P0 by its share; with controls it moves); and where is_vertical.
  /// Joins are C0 then, and slope_factor is 0.
  bool moves_p1 = true;
  bool is_vertical = false;  ///< a 2-D curve that begins vertically has no slope to keep

  struct Deltas {
    double dp0 = 0;
    double dp1 = 0;
    bool limited = false;  ///< p1 hit the hull: C0 join, slope as near as the hull allows
  };
  /// [audio] value0: where the output is; slope0: its slope by u of this section.
  Deltas join(double value0, double slope0) const KNOTWAVE_RT;
  /// Starts at value0 and leaves the slope to the curve (C0). [audio]
  Deltas join_c0(double value0) const KNOTWAVE_RT;
  /// The same where controls have moved the program: its value and slope at u_join as they are now
  /// take the place of p0 and p1. [audio] The bases stay those of the rest curve, so value and
  /// slope still join exactly and the tail is still untouched.
  Deltas join_from(double program_value, double program_slope, double value0,
                   double slope0) const KNOTWAVE_RT;
  Deltas join_c0_from(double program_value, double value0) const KNOTWAVE_RT;
};

/// dim 1 or 2 (function form). Above degree 7 the bases are fitted as compile_function() fits the
/// curve: value and slope join all the same, and what B0 and B1 play between is within max_error of
/// them. u_join is a parameter of the compiled function (for 2-D
/// curves a time). Errors: parameter_out_of_range, and those of compile_function.
Result<JoinProgram> compile_join(const NurbsCurve& curve, double u_join,
                                 const CompileOptions& options = {});

}  // namespace knotwave::curves
