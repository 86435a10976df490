// SPDX-License-Identifier: MIT
// With edit_options.cpp all of knotwave-curve that knows CLI11.
#include "options.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>

#include "knotwave/base/file.h"

#include "command_line/options.h"
#include "edit_options.h"

namespace knotwave::curve_app {
namespace {

constexpr const char* kAbout =
    "Checks, describes, evaluates, draws, edits and fits curves and surfaces.\n"
    "FILE is a curve file, or a patch that holds curves; FILE#NAME is one of them.";

constexpr const char* kMore =
    "knotwave-curve COMMAND --help says more about each.\n"
    "Exit codes: 0 done, 1 failure, 2 wrong usage, 75 try again (disk full, out of\n"
    "memory).";

constexpr const char* kCheckExample = "Example:\n  knotwave-curve check examples/curves/*.toml";
constexpr const char* kInfoExample =
    "Example:\n  knotwave-curve info examples/curves/decay.toml#decay60";
constexpr const char* kEvalExample =
    "Prints a line for each place, with tabs between: u (of a surface u and v), the\n"
    "coordinates, then those of each derivative, with all the digits a double has.\n"
    "The first example prints u, the value and the slope:\n"
    "  0     1                    -6.9070297066539474\n"
    "  0.25  0.17782554727999572  -1.2283864077044784\n"
    "  1     0.001                -0.0069004935640000001\n"
    "Examples:\n"
    "  knotwave-curve eval examples/curves/decay.toml#decay60 --at 0,0.25,1 --derivatives 1\n"
    "  knotwave-curve eval examples/curves/decay.toml#decay60 --grid 64\n"
    "  knotwave-curve eval examples/curves/surfaces.toml#hill --at 0:0,0.5:1";
constexpr const char* kPlotExample =
    "Examples:\n"
    "  knotwave-curve plot examples/curves/decay.toml#decay60 -o decay60.svg\n"
    "  knotwave-curve plot examples/curves/decay.toml#decay60";

/// In the order of Verb.
constexpr auto kVerbs = std::to_array<std::string_view>(
    {"check", "info", "eval", "plot", "split", "insert-knot", "elevate", "simplify", "morph", "iso",
     "fit", "import", "export"});

using command_line::number_in;

/// "0,0.25,1" or "0:0.5,1:0.5". Empty when all is well, else what is wrong.
std::string read_places(const std::string& text, std::vector<Parameter>& places) {
  for (std::string_view rest = text;; rest.remove_prefix(rest.find(',') + 1)) {
    const std::string_view word = rest.substr(0, rest.find(','));
    const auto colon = word.find(':');
    const auto u = number_in(word.substr(0, colon));
    Parameter place{u.value_or(0), {}};
    if (colon != std::string_view::npos) place.v = number_in(word.substr(colon + 1));
    if (!u || (colon != std::string_view::npos && !place.v)) {
      return "'" + std::string(word) +
             "' is neither a number u nor a pair u:v (no blanks around the commas)";
    }
    places.push_back(place);
    if (rest.find(',') == std::string_view::npos) return {};
  }
}

std::string read_size(const std::string& text, CurveOptions& o) {
  const auto cross = text.find('x');
  const auto width = number_in(std::string_view(text).substr(0, cross));
  const auto height = cross == std::string::npos
                          ? std::nullopt
                          : number_in(std::string_view(text).substr(cross + 1));
  const auto fits = [](std::optional<double> side) {
    return side && *side >= 200 && *side <= 8000 && *side == static_cast<int>(*side);
  };
  if (!fits(width) || !fits(height)) {
    return "'" + text + "' is not WIDTHxHEIGHT with sides of 200 to 8000 pixels";
  }
  o.width_px = static_cast<int>(*width);
  o.height_px = static_cast<int>(*height);
  return {};
}

void add_file(CLI::App& verb, CurveOptions& o) {
  verb.add_option("FILE", o.files, "curve file or patch; FILE#NAME for one of several")
      ->expected(1)
      ->type_name("");
}

void add_check(CLI::App& app, CurveOptions& o) {
  CLI::App* check = app.add_subcommand("check", "read files of any kind and report their faults");
  check->footer(kCheckExample);
  check->add_option("FILE", o.files, "curve files, patches, banks")->type_name("");
}

void add_info(CLI::App& app, CurveOptions& o) {
  CLI::App* info = app.add_subcommand("info", "what a curve is: degree, knots, range, smoothness");
  info->footer(kInfoExample);
  add_file(*info, o);
  command_line::add_flag(*info, {"--json", "as JSON", ""}, o.json);
}

void add_eval(CLI::App& app, CurveOptions& o) {
  CLI::App* eval =
      app.add_subcommand("eval", "a table of u, the coordinates, and their derivatives");
  eval->footer(kEvalExample);
  add_file(*eval, o);
  command_line::add_checked(*eval,
                            {"--at", "parameters: U,U,... or, for a surface, U:V,U:V,...", "LIST"},
                            [&o](const std::string& text) { return read_places(text, o.at); });
  command_line::add_number(
      *eval, {"--grid", "steps over the domain: one row more, both ends exact", "STEPS"}, o.grid, 1,
      1000000);
  command_line::add_number(*eval,
                           {"--derivatives",
                            "derivatives by u up to this order, from the "
                            "right",
                            "ORDER"},
                           o.derivatives, 0, 15);
  command_line::add_flag(*eval, {"--json", "as JSON", ""}, o.json);
}

void add_plot(CLI::App& app, CurveOptions& o) {
  CLI::App* plot = app.add_subcommand("plot", "a picture; without -o as text for the terminal");
  plot->footer(kPlotExample);
  add_file(*plot, o);
  command_line::add_text(
      *plot, {"-o,--output", "file to write: .svg or .png by its ending", "FILE"}, o.output);
  command_line::add_checked(
      *plot, {"--size", "pixels, 200x200 to 8000x8000 (960x540 if not given)", "WxH"},
      [&o](const std::string& text) { return read_size(text, o); });
  command_line::add_number(*plot, {"--columns", "width of the text picture", ""}, o.columns, 28,
                           400);
  command_line::add_number(*plot, {"--rows", "height of the text picture", ""}, o.rows, 6, 200);
}

/// What is wrong with options that are each good in themselves; empty when nothing is.
std::string conflict(const CurveOptions& o) {
  if (o.files.empty()) {
    const bool is_other = o.verb == Verb::fit || o.verb == Verb::import_svg;
    return is_other ? "which file? a FILE is needed"
                    : "which curve? a FILE is needed, or FILE#NAME";
  }
  if (o.verb == Verb::eval && o.at.empty() == (o.grid == 0)) {
    return o.at.empty() ? "where? --at LIST or --grid STEPS" : "--at and --grid exclude each other";
  }
  const auto ends = [&o](std::string_view ending) { return base::has_ending(o.output, ending); };
  if (o.verb == Verb::plot && !o.output.empty() && !ends(".svg") && !ends(".png")) {
    return "--output: '" + o.output + "' ends neither in .svg nor in .png";
  }
  return o.verb < Verb::split ? "" : edit_conflict(o);
}

std::string all_verbs() {
  std::string text = "what to do?";
  for (const auto verb : kVerbs) {
    text += (verb == kVerbs.front()  ? " "
             : verb == kVerbs.back() ? " or "
                                     : ", ") +
            std::string(verb);
  }
  return text;
}

}  // namespace

CommandLine read_command_line(int argc, char** argv) {
  CommandLine line;
  CurveOptions& options = line.options;
  CLI::App app(kAbout, "knotwave-curve");
  command_line::prepare(app, kMore);
  app.require_subcommand(0, 1);
  add_check(app, options);
  add_info(app, options);
  add_eval(app, options);
  add_plot(app, options);
  add_edits(app, options);
  line.exit_code = command_line::read_words(app, argc, argv, [&]() -> std::string {
    const auto verbs = app.get_subcommands();
    if (verbs.empty()) return all_verbs();
    const auto verb = std::find(kVerbs.begin(), kVerbs.end(), verbs.front()->get_name());
    options.verb = static_cast<Verb>(verb - kVerbs.begin());
    return conflict(options);
  });
  return line;
}

}  // namespace knotwave::curve_app
