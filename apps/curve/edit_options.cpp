// SPDX-License-Identifier: MIT
#include "edit_options.h"

#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>

#include "knotwave/base/file.h"
#include "knotwave/curves/curve_file.h"

#include "command_line/options.h"

namespace knotwave::curve_app {
namespace {

constexpr const char* kSplitExample =
    "Example:\n"
    "  knotwave-curve split examples/curves/decay.toml#decay60 --at 0.5 -o half.toml\n"
    "writes decay60_left and decay60_right; of a surface NAME_low and NAME_high.";
constexpr const char* kInsertExample =
    "Example:\n"
    "  knotwave-curve insert-knot examples/curves/decay.toml#decay60 --at 0.25,0.5";
constexpr const char* kElevateExample =
    "Example:\n"
    "  knotwave-curve elevate examples/curves/decay.toml#decay60 --times 2 -o d6.toml";
constexpr const char* kSimplifyExample =
    "Example:\n"
    "  knotwave-curve simplify examples/curves/waves.toml#reed --within -20 -o s.toml\n"
    "No place of the result is farther off than it says: that is proved, not sampled.";
constexpr const char* kMorphExample =
    "Example:\n"
    "  knotwave-curve morph examples/curves/waves.toml#hollow \\\n"
    "    examples/curves/waves.toml#reed --amount 0.25 --name between -o b.toml";
constexpr const char* kIsoExample =
    "Example:\n"
    "  knotwave-curve iso examples/curves/surfaces.toml#hill --v 0,0.5,1 -o v.toml";
constexpr const char* kFitExample =
    "Examples:\n"
    "  knotwave-curve fit fader.csv --within -60 --name fader -o fader.toml\n"
    "  knotwave-curve fit cycle.wav --points 24 -o cycle.toml\n"
    "A row of a table is a time and 1 to 4 values, or one value; a first row of\n"
    "words and lines that begin with # are skipped. What eval prints of a curve is\n"
    "such a table; leave out --derivatives. Of a sound, u is seconds and channels\n"
    "are coordinates. --within holds between the data too.";
constexpr const char* kImportExample =
    "Examples:\n"
    "  knotwave-curve import drawing.svg -o drawn.toml\n"
    "  knotwave-curve import drawing.svg --path attack --unit-square -o attack.toml\n"
    "Transforms of the drawing are not applied. A file that does not begin with <\n"
    "is read as the d of one path.";
constexpr const char* kExportExample =
    "Example:\n"
    "  knotwave-curve export examples/curves/decay.toml#decay60 -o decay60.svg";

/// "0,0.25,1". Empty when all is well, else what is wrong.
std::string read_numbers(const std::string& text, std::vector<double>& numbers) {
  for (std::string_view rest = text;; rest.remove_prefix(rest.find(',') + 1)) {
    const std::string_view word = rest.substr(0, rest.find(','));
    const auto number = command_line::number_in(word);
    if (!number) {
      return "'" + std::string(word) + "' is not a number (no blanks around the commas)";
    }
    numbers.push_back(*number);
    if (rest.find(',') == std::string_view::npos) return {};
  }
}

void add_list(CLI::App& verb, const std::string& option, const std::string& about,
              std::vector<double>& target) {
  command_line::add_checked(verb, {option, about, "LIST"}, [&target](const std::string& text) {
    return read_numbers(text, target);
  });
}

/// A command with its input, its output and the name of what it makes.
CLI::App* add_edit(CLI::App& app, CurveOptions& o, const char* name, const std::string& about,
                   const char* example, const char* input, const char* output) {
  CLI::App* verb = app.add_subcommand(name, about);
  verb->footer(example);
  verb->add_option("FILE", o.files, input)
      ->expected(1, std::string_view(name) == "morph" ? 2 : 1)
      ->type_name("");
  command_line::add_text(*verb, {"-o,--output", output, "FILE"}, o.output);
  return verb;
}

constexpr const char* kCurveInput = "curve file or patch; FILE#NAME for one of several";
constexpr const char* kTomlOutput = "file to write (.toml); the terminal if not given";

void add_name(CLI::App& verb, CurveOptions& o) {
  command_line::add_checked(verb, {"--name", "name of the result", "NAME"},
                            [&o](const std::string& text) -> std::string {
                              if (!curves::is_valid_name(text)) {
                                return "'" + text + "' is not 1 to 64 letters, digits, '_' and '-'";
                              }
                              o.name = text;
                              return {};
                            });
}

void add_direction(CLI::App& verb, CurveOptions& o) {
  command_line::add_choice(verb, {"--direction", "of a surface: along u or along v", ""},
                           {"u", "v"}, [&o](std::size_t index) {
                             o.direction = index == 0 ? curves::Direction::u : curves::Direction::v;
                           });
}

void add_within(CLI::App& verb, CurveOptions& o) {
  command_line::add_checked(
      verb, {"--within", "decibels below the largest value (-240 to 0; -80 if not given)", "DB"},
      [&o](const std::string& text) -> std::string {
        o.within_db = command_line::number_in(text);
        const bool fits = o.within_db && *o.within_db >= -240 && *o.within_db <= 0;
        return fits ? "" : "'" + text + "' is not a number from -240 to 0";
      });
}

void add_exact_edits(CLI::App& app, CurveOptions& o) {
  CLI::App* split = add_edit(app, o, "split", "one curve or surface into two, at a place",
                             kSplitExample, kCurveInput, kTomlOutput);
  add_list(*split, "--at", "where: a parameter inside the domain", o.knots);
  add_direction(*split, o);
  add_name(*split, o);
  CLI::App* insert = add_edit(app, o, "insert-knot", "more knots, the same curve or surface",
                              kInsertExample, kCurveInput, kTomlOutput);
  add_list(*insert, "--at", "where: U,U,... inside the domain", o.knots);
  command_line::add_number(*insert, {"--times", "how often each", ""}, o.times, 1, 15);
  add_direction(*insert, o);
  add_name(*insert, o);
  CLI::App* elevate = add_edit(app, o, "elevate", "a higher degree, the same curve or surface",
                               kElevateExample, kCurveInput, kTomlOutput);
  command_line::add_number(*elevate, {"--times", "degrees more", ""}, o.times, 1, 14);
  add_direction(*elevate, o);
  add_name(*elevate, o);
}

void add_mixes(CLI::App& app, CurveOptions& o) {
  CLI::App* simplify = add_edit(app, o, "simplify", "fewer knots, and how far off it is at most",
                                kSimplifyExample, kCurveInput, kTomlOutput);
  add_within(*simplify, o);
  command_line::add_number(*simplify, {"--degree", "lower the degree to this first", ""}, o.degree,
                           1, 14);
  add_name(*simplify, o);
  CLI::App* morph = add_edit(app, o, "morph", "between two curves, however different they are",
                             kMorphExample, "two of FILE#NAME", kTomlOutput);
  command_line::add_number(*morph, {"--amount", "0 is the first, 1 the second", ""}, o.amount, 0,
                           1);
  add_name(*morph, o);
  CLI::App* iso = add_edit(app, o, "iso", "curves along a surface, where u or v stays", kIsoExample,
                           "curve file or patch; FILE#NAME", kTomlOutput);
  add_list(*iso, "--u", "curves in v at these u", o.iso_u);
  add_list(*iso, "--v", "curves in u at these v", o.iso_v);
  add_name(*iso, o);
}

void add_exchanges(CLI::App& app, CurveOptions& o) {
  CLI::App* fit =
      add_edit(app, o, "fit", "a curve near a table of numbers, or near a sound", kFitExample,
               "table (.csv, .tsv, .txt) or sound (.wav, .flac)", kTomlOutput);
  add_within(*fit, o);
  command_line::add_number(*fit, {"--points", "exactly so many, as near as they can", ""}, o.points,
                           2, curves::kMaxPoints);
  command_line::add_number(*fit, {"--degree", "of the curve: 3 if not given", ""}, o.degree, 1,
                           curves::kMaxDegree);
  add_name(*fit, o);
  CLI::App* import_svg = add_edit(app, o, "import", "the paths of an SVG drawing as curves",
                                  kImportExample, "SVG drawing, or the d of a path", kTomlOutput);
  command_line::add_text(*import_svg, {"--path", "only the path with this id", "ID"}, o.path_id);
  command_line::add_flag(*import_svg, {"--down", "keep y as it is: downwards", ""}, o.y_down);
  command_line::add_flag(*import_svg,
                         {"--unit-square", "stretch each curve onto 0 to 1 in x and in y", ""},
                         o.unit_square);
  add_name(*import_svg, o);
  CLI::App* export_svg =
      add_edit(app, o, "export", "a curve as the path of an SVG drawing", kExportExample,
               kCurveInput, "file to write (.svg); the terminal if not given");
  add_within(*export_svg, o);
}

}  // namespace

void add_edits(CLI::App& app, CurveOptions& options) {
  add_exact_edits(app, options);
  add_mixes(app, options);
  add_exchanges(app, options);
}

std::string edit_conflict(const CurveOptions& o) {
  const std::string ending = o.verb == Verb::export_svg ? ".svg" : ".toml";
  if (!o.output.empty() && o.output != "-" && !base::has_ending(o.output, ending)) {
    return "--output: '" + o.output + "' does not end in " + ending;
  }
  switch (o.verb) {
    case Verb::split:
      return o.knots.size() == 1 ? "" : "where? one place is needed: --at U";
    case Verb::insert_knot:
      return o.knots.empty() ? "where? --at U,U,..." : "";
    case Verb::morph:
      if (o.files.size() != 2) return "two curves are needed: FILE#NAME FILE#NAME";
      return o.amount < 0 ? "how far? --amount 0 (the first) to 1 (the second)" : "";
    case Verb::iso:
      if (o.iso_u.empty() == o.iso_v.empty()) {
        return o.iso_u.empty() ? "where? --u LIST or --v LIST" : "--u and --v exclude each other";
      }
      return {};
    case Verb::fit:
      return o.points > 0 && o.within_db ? "--within and --points exclude each other" : "";
    default:
      return {};
  }
}

}  // namespace knotwave::curve_app
