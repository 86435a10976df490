// SPDX-License-Identifier: MIT
// What the command line of knotwave-curve asks for.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "knotwave/curves/surface_algorithms.h"

namespace knotwave::curve_app {

enum class Verb {
  check,
  info,
  eval,
  plot,
  split,
  insert_knot,
  elevate,
  simplify,
  morph,
  iso,
  fit,
  import_svg,
  export_svg
};

/// A place to evaluate at: u, and v for surfaces.
struct Parameter {
  double u = 0;
  std::optional<double> v;
};

struct CurveOptions {
  Verb verb = Verb::check;
  std::vector<std::string> files;  ///< check: any number; morph: two; others: one FILE[#name]
  std::vector<Parameter> at;       ///< eval
  int grid = 0;                    ///< eval: steps over the domain; 0 = --at
  int derivatives = 0;
  bool json = false;
  /// plot: .svg or .png, empty = text; export: .svg; others: .toml. "-" = standard output.
  std::string output;
  int width_px = 960;
  int height_px = 540;
  int columns = 72;
  int rows = 14;
  std::string name;           ///< of the result; empty = that of the curve
  std::vector<double> knots;  ///< split: one; insert-knot: any number
  std::vector<double> iso_u, iso_v;
  std::optional<curves::Direction> direction;  ///< given for surfaces, and only for them
  int times = 1;
  int degree = 0;                   ///< simplify: lower it to this; 0 = keep; fit: 0 = 3
  std::optional<double> within_db;  ///< below the largest value; kWithinDb if not given
  int points = 0;                   ///< fit: exactly so many; 0 = as many as the bound needs
  double amount = -1;               ///< morph: 0 to 1; below 0 = not given
  std::string path_id;              ///< import: the path meant; empty = all
  bool y_down = false;
  bool unit_square = false;
};

inline constexpr double kWithinDb = -80;

/// A command line read: options, or an exit code when there is nothing (more) to do.
struct CommandLine {
  CurveOptions options;
  std::optional<int> exit_code;
};

/// Prints help, version and usage errors itself.
CommandLine read_command_line(int argc, char** argv);

}  // namespace knotwave::curve_app
