// SPDX-License-Identifier: MIT
// Steps of compile() that its forms share. Private to curves. [control]
#pragma once
#include <string>

#include "knotwave/curves/compile.h"

#include "compile_controls.h"
#include "program_builder.h"
#include "span_polynomial.h"

namespace knotwave::curves {

/// Every span of the curve as it is, one weight for all points divided out: no error but rounding.
/// Degree <= kMaxPieceDegree.
ProgramParts exact_parts(const NurbsCurve& curve, const std::vector<ControlRange>& controls);

/// How fitted pieces of a span meet: in value, or in value and slope.
enum class Meeting { value, slope };
/// Every span within max_error, proved, by polynomial pieces: for rational spans and high degrees.
Result<ProgramParts> fitted_parts(const NurbsCurve& curve, const CompileOptions& options,
                                  Meeting meeting);

/// Hull, controls, period, and the values at clamped ends: all but the pieces.
ProgramParts frame_of(const NurbsCurve& curve, const std::vector<ControlRange>& controls);

/// What a program of exact_parts() without controls can be from the curve, by the size of its
/// coefficients: proved, quick and wide. Infinity where weights lie so far apart that nothing is.
double rounding_bound(const ProgramParts& parts);

/// Largest |program - curve| found over all coordinates, with controls at rest and at every corner
/// of their ranges: spans as they are, so it is rounding, which is random. It is doubled for places
/// nobody looked at, and 4 ulp of the largest value are added.
Result<double> measured_error(const CurveProgram& program, const NurbsCurve& curve,
                              const std::vector<ControlRange>& controls);

/// error_bound_missed, with both numbers.
Error missed_bound(const NurbsCurve& curve, double error, double asked, const std::string& why);
/// The same code where max_pieces stopped the fit; nobody knows the error then.
Error too_many_pieces(const NurbsCurve& curve, const CompileOptions& options);

}  // namespace knotwave::curves
