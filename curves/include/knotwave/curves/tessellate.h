// SPDX-License-Identifier: MIT
// Curves as few straight steps, by a policy, handed to call-backs: the sampling methods and the
// tessellator of GLU, for automation lanes, MIDI controllers, break-point files and plots.
// [control] docs/from-opengl.md goes through them call by call.
// Source: Khronos, GLU 1.3 reference pages gluNurbsProperty, gluNurbsCallback.
#pragma once
#include <functional>
#include <span>
#include <variant>
#include <vector>

#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

/// Equal steps of u over each stretch, at least `steps_per_u` for each unit of u
/// (GLU_DOMAIN_DISTANCE).
struct FixedStep {
  double steps_per_u = 100;
};
/// The straight lines are at no u, any double, farther from the curve than error_db re full_scale
/// (GLU_PARAMETRIC_ERROR). Proved from Bézier points, the rounding of values included.
struct MaxError {
  double error_db = -96;
  double full_scale = 1;
};
/// No coordinate moves by more than `size` within a step, not even to come back (GLU_PATH_LENGTH):
/// the greatest slew. Proved by hulls. Weights of 1e-6 beside 1e6 may move a curve by more than
/// `size` between two neighbouring doubles of u; that is an error, with the place.
struct MaxStep {
  double size = 1.0 / 127;
};
using Sampling = std::variant<FixedStep, MaxError, MaxStep>;

/// Parameters that increase, the first and the last included; no jump of the curve lies between.
using Stretch = std::vector<double>;

/// Where a curve is sampled over [u_a, u_b]: stretches between its jumps, steps nearly as long as
/// the policy allows. Knots of multiplicity >= degree (corners) are always among them. Errors:
/// value_out_of_range (a policy's number is not positive or not finite), parameter_out_of_range
/// (u_a or u_b outside the domain), empty_domain (u_a >= u_b), error_bound_missed (no step is short
/// enough: values are rounded by more than MaxError asks for, or two neighbouring doubles of u are
/// more than MaxStep apart), too_many_points (over max_values). Cost: about 10 us a value for
/// cubics, which are found one after the other.
Result<std::vector<Stretch>> sample_parameters(const NurbsCurve& curve, const Sampling& sampling,
                                               double u_a, double u_b, int max_values = 1 << 20);

/// What is called, in order of u; empty ones are not. Weights are divided out.
struct TessellatorCalls {
  std::function<void(double u)> begin;                           ///< a stretch begins
  std::function<void(double u, std::span<const double>)> value;  ///< [dim]
  std::function<void(double u, std::span<const double>)> slope;  ///< by u, [dim], after its value
  std::function<void(double u)> end;                             ///< a stretch ends
};

/// Calls begin, then value and slope for every parameter, then end, for each stretch of the domain.
/// The last of a stretch are left-hand limits, all others right-hand ones. Errors: those of
/// sample_parameters(); nothing is called then.
Result<void> tessellate(const NurbsCurve& curve, const Sampling& sampling,
                        const TessellatorCalls& calls, int max_values = 1 << 20);

}  // namespace knotwave::curves
