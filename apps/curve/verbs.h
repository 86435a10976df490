// SPDX-License-Identifier: MIT
// What knotwave-curve does: one function a command. Each returns the text for standard output, or
// what is wrong.
#pragma once
#include <string>

#include "knotwave/base/result.h"

#include "options.h"

namespace knotwave::curve_app {

/// One line a good file; warnings and the faults of the others go to standard error. Sets `failed`.
std::string check_text(const CurveOptions& options, bool& failed);
Result<std::string> info_text(const CurveOptions& options);
Result<std::string> eval_text(const CurveOptions& options);
/// Writes the picture, or gives it as text.
Result<std::string> plot_text_or_file(const CurveOptions& options);

/// The commands that make something: what the file is to hold, and what is to be said of it.
struct Made {
  std::string text;
  std::string report;
};
Result<Made> split_in_two(const CurveOptions& options);
Result<Made> with_knots(const CurveOptions& options);
Result<Made> elevated(const CurveOptions& options);
Result<Made> simplified(const CurveOptions& options);
Result<Made> morphed(const CurveOptions& options);
Result<Made> iso_curves(const CurveOptions& options);
Result<Made> fitted(const CurveOptions& options);
Result<Made> imported(const CurveOptions& options);
Result<Made> exported(const CurveOptions& options);

}  // namespace knotwave::curve_app
