// SPDX-License-Identifier: MIT
// A curve whose first coordinate is time, as explicit functions of that time. Private to curves.
// [control]
#pragma once
#include "compile_parts.h"

namespace knotwave::curves {

/// Coordinates 1.. of `curve` as functions of coordinate 0 within max_error, proved. Errors:
/// not_a_function, empty_domain (time stands still), error_bound_missed. All but the hull, which is
/// that of the coordinates, is filled in; time standing still for a while becomes a jump.
Result<ProgramParts> inverted_parts(const NurbsCurve& curve, const CompileOptions& options);

/// inverted_parts() as a program.
Result<CurveProgram> compile_timed(const NurbsCurve& curve, const CompileOptions& options);

/// The curve's own parameter at time x (the last one, where time stands still): what a join in x
/// splits the curve at. `curve` has been inverted before; x inside its times.
double parameter_at_time(const NurbsCurve& curve, double x);

}  // namespace knotwave::curves
