// SPDX-License-Identifier: MIT
// What the command line of knotwave-curve asks for.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace knotwave::curve_app {

enum class Verb { check, info, eval, plot };

/// A place to evaluate at: u, and v for surfaces.
struct Parameter {
  double u = 0;
  std::optional<double> v;
};

struct CurveOptions {
  Verb verb = Verb::check;
  std::vector<std::string> files;  ///< check: any number; others: one FILE[#name]
  std::vector<Parameter> at;       ///< eval
  int grid = 0;                    ///< eval: steps over the domain; 0 = --at
  int derivatives = 0;
  bool json = false;
  std::string output;  ///< plot: .svg or .png; empty = text
  int width_px = 960;
  int height_px = 540;
  int columns = 72;
  int rows = 14;
};

/// A command line read: options, or an exit code when there is nothing (more) to do.
struct CommandLine {
  CurveOptions options;
  std::optional<int> exit_code;
};

/// Prints help, version and usage errors itself.
CommandLine read_command_line(int argc, char** argv);

}  // namespace knotwave::curve_app
