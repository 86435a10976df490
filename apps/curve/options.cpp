// SPDX-License-Identifier: MIT
// The only file of knotwave-curve that knows CLI11.
#include "options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <string_view>

#include <CLI/CLI.hpp>

#include "knotwave/base/suggest.h"

namespace knotwave::curve_app {
namespace {

constexpr const char* kAbout =
    "Checks, describes, evaluates and draws Knotwave curves and surfaces.\n"
    "FILE is a curve file, or a patch that holds curves; FILE#NAME is one of them.";

constexpr const char* kMore =
    "Examples:\n"
    "  knotwave-curve check examples/curves/*.toml\n"
    "  knotwave-curve info examples/curves/decay.toml#decay60\n"
    "  knotwave-curve eval examples/curves/decay.toml#decay60 --at 0,0.25,1 --derivatives 1\n"
    "  knotwave-curve eval examples/curves/decay.toml#decay60 --grid 64\n"
    "  knotwave-curve plot examples/curves/decay.toml#decay60 -o decay60.svg\n"
    "  knotwave-curve plot examples/curves/decay.toml#decay60\n"
    "\n"
    "Exit codes: 0 done, 1 failure, 2 wrong usage.";

constexpr auto kVerbs = std::to_array<std::string_view>({"check", "info", "eval", "plot"});
constexpr auto kOptionNames =
    std::to_array<std::string_view>({"--help", "--version", "--at", "--grid", "--derivatives",
                                     "--json", "--output", "--size", "--columns", "--rows"});

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || read.ec != std::errc() || read.ptr != text.data() + text.size()) return {};
  return value == value ? std::optional(value) : std::nullopt;
}

/// "0,0.25,1" or "0:0.5,1:0.5". Empty when all is well, else what is wrong.
std::string read_places(const std::string& text, std::vector<Parameter>& places) {
  for (std::string_view rest = text;; rest.remove_prefix(rest.find(',') + 1)) {
    const std::string_view word = rest.substr(0, rest.find(','));
    const auto colon = word.find(':');
    const auto u = number_of(word.substr(0, colon));
    Parameter place{u.value_or(0), {}};
    if (colon != std::string_view::npos) place.v = number_of(word.substr(colon + 1));
    if (!u || (colon != std::string_view::npos && !place.v)) {
      return "--at: '" + std::string(word) + "' is neither a number u nor a pair u:v";
    }
    places.push_back(place);
    if (rest.find(',') == std::string_view::npos) return {};
  }
}

std::string read_size(const std::string& text, CurveOptions& o) {
  const auto cross = text.find('x');
  const auto width = number_of(std::string_view(text).substr(0, cross));
  const auto height = cross == std::string::npos
                          ? std::nullopt
                          : number_of(std::string_view(text).substr(cross + 1));
  const auto fits = [](std::optional<double> side) {
    return side && *side >= 200 && *side <= 8000 && *side == static_cast<int>(*side);
  };
  if (!fits(width) || !fits(height)) {
    return "--size: '" + text + "' is not WIDTHxHEIGHT with sides of 200 to 8000 pixels";
  }
  o.width_px = static_cast<int>(*width);
  o.height_px = static_cast<int>(*height);
  return {};
}

struct Texts {
  std::string at, size;
};

void add_verbs(CLI::App& app, CurveOptions& o, Texts& texts) {
  const auto file = [&o](CLI::App* verb) {
    verb->add_option("FILE", o.files, "curve file or patch; FILE#NAME for one of several")
        ->required()
        ->expected(1)
        ->type_name("");
  };
  CLI::App* check = app.add_subcommand("check", "read files of any kind and report their faults");
  check->add_option("FILE", o.files, "curve files, patches, banks")->required()->type_name("");
  CLI::App* info = app.add_subcommand("info", "what a curve is: degree, knots, range, smoothness");
  file(info);
  info->add_flag("--json", o.json, "as JSON");
  CLI::App* eval = app.add_subcommand(
      "eval", "values: u, then each coordinate, then those of each derivative, tabs between");
  file(eval);
  eval->add_option("--at", texts.at, "parameters: U,U,... or, for a surface, U:V,U:V,...")
      ->type_name("LIST");
  eval->add_option("--grid", o.grid, "N steps over the domain: N + 1 rows, both ends exact")
      ->check(CLI::Range(1, 1000000).description(""))
      ->type_name("N");
  eval->add_option("--derivatives", o.derivatives,
                   "derivatives by u up to this order, from the right")
      ->check(CLI::Range(0, 15).description(""))
      ->type_name("K");
  eval->add_flag("--json", o.json, "as JSON");
  CLI::App* plot = app.add_subcommand("plot", "a picture; without -o as text for the terminal");
  file(plot);
  plot->add_option("-o,--output", o.output, "file to write: .svg or .png by its ending")
      ->type_name("FILE");
  plot->add_option("--size", texts.size, "pixels, 960x540 by default")->type_name("WxH");
  plot->add_option("--columns", o.columns, "width of the text picture")
      ->check(CLI::Range(28, 400).description(""))
      ->capture_default_str();
  plot->add_option("--rows", o.rows, "height of the text picture")
      ->check(CLI::Range(6, 200).description(""))
      ->capture_default_str();
}

/// What is wrong with options that are each good in themselves; empty when nothing is.
std::string conflict(const CurveOptions& o) {
  if (o.verb == Verb::eval && o.at.empty() == (o.grid == 0)) {
    return "where? --at LIST or --grid N, one of them";
  }
  const auto ends = [&o](std::string_view ending) { return o.output.ends_with(ending); };
  if (o.verb == Verb::plot && !o.output.empty() && !ends(".svg") && !ends(".png")) {
    return "-o: '" + o.output + "' ends neither in .svg nor in .png";
  }
  return {};
}

/// A better message than "argument not expected" for a wrong verb or option; empty without one.
std::string unknown_word(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word(argv[i]);
    const std::string_view name = word.substr(0, word.find('='));
    if (!name.starts_with("--") || name.size() == 2) continue;
    if (std::find(kOptionNames.begin(), kOptionNames.end(), name) == kOptionNames.end()) {
      return "unknown option '" + std::string(name) + "'" + base::suggestion(name, kOptionNames);
    }
  }
  if (argc < 2 || argv[1][0] == '-') return {};
  const std::string_view verb(argv[1]);
  if (std::find(kVerbs.begin(), kVerbs.end(), verb) != kVerbs.end()) return {};
  return "unknown command '" + std::string(verb) + "'" + base::suggestion(verb, kVerbs);
}

int usage_error(const std::string& message) {
  std::fprintf(stderr, "knotwave-curve: %s\nTry 'knotwave-curve --help'.\n", message.c_str());
  return kExitUsage;
}

}  // namespace

CommandLine read_command_line(int argc, char** argv) {
  CommandLine line;
  CurveOptions& options = line.options;
  Texts texts;
  CLI::App app(kAbout, "knotwave-curve");
  app.footer(kMore);
  app.set_version_flag("--version", std::string("knotwave-curve ") + KNOTWAVE_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(26);
  add_verbs(app, options, texts);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& done) {
    line.exit_code = app.exit(done);
    return line;
  } catch (const CLI::ParseError& error) {
    const std::string unknown = unknown_word(argc, argv);
    line.exit_code = usage_error(unknown.empty() ? error.what() : unknown);
    return line;
  }
  const std::string verb = app.get_subcommands().front()->get_name();
  options.verb = static_cast<Verb>(std::find(kVerbs.begin(), kVerbs.end(), verb) - kVerbs.begin());
  std::string problem = texts.at.empty() ? "" : read_places(texts.at, options.at);
  if (problem.empty() && !texts.size.empty()) problem = read_size(texts.size, options);
  if (problem.empty()) problem = conflict(options);
  if (!problem.empty()) line.exit_code = usage_error(problem);
  return line;
}

}  // namespace knotwave::curve_app
