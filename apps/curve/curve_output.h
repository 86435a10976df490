// SPDX-License-Identifier: MIT
// What the commands that make curves give: a curve file and a report.
#pragma once
#include <string>

#include "knotwave/curves/curve_file.h"

#include "verbs.h"

namespace knotwave::curve_app {

/// What is wrong with writing over a file that is read; empty when nothing is.
std::string output_overlap(const CurveOptions& options);

/// The same shape, called `name`. Errors: usage (not a name).
Result<curves::NurbsCurve> renamed(const curves::NurbsCurve& curve, const std::string& name);
Result<curves::NurbsSurface> renamed(const curves::NurbsSurface& surface, const std::string& name);

/// A line for each shape, then `facts`, a line or none. Errors: file_too_large.
Result<Made> made_of(const curves::CurveSet& set, const std::string& facts = {});

/// "0.00098 (-60.2 dB)": against the largest value. "0" when exact.
std::string error_text(double error, double largest);

/// Largest magnitude of a value in any coordinate; 1 for a curve that is 0.
double largest_value(const curves::NurbsCurve& curve);
/// What `options.within_db` allows of it.
double tolerance_of(const CurveOptions& options, double largest);

/// The same error, told of the curve that was asked for.
Error told_of(const std::string& source, Error error);

}  // namespace knotwave::curve_app
