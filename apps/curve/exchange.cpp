// SPDX-License-Identifier: MIT
// Curves from and to SVG drawings.
#include <algorithm>
#include <cstdio>
#include <set>

#include "knotwave/base/file.h"
#include "knotwave/base/suggest.h"
#include "knotwave/curves/analysis.h"
#include "knotwave/curves/svg_path.h"

#include "curve_input.h"
#include "curve_output.h"
#include "svg_file.h"

namespace knotwave::curve_app {
namespace {

using curves::NurbsCurve;

constexpr std::size_t kMaxDrawingBytes = std::size_t{64} << 20;
constexpr std::size_t kMaxCurves = 4096;

Error error_in(const std::string& path, ErrorCode code, std::string message) {
  return {code, std::move(message), path, 0, 0, -1};
}

/// The paths asked for. Text that is no XML is the d of one.
Result<std::vector<SvgElement>> paths_of(const std::string& text, const CurveOptions& options) {
  const std::string& path = options.files.front();
  const std::size_t start = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (start == std::string::npos || text[start] != '<') {
    if (options.path_id.empty()) return std::vector<SvgElement>{{"", text, 1, false}};
    return error_in(path, ErrorCode::unknown_name, "no drawing: --path has nothing to look in");
  }
  auto all = svg_paths(text, path);
  if (!all || options.path_id.empty()) {
    if (!all || !all->empty()) return all;
    return error_in(path, ErrorCode::unknown_name,
                    "there is no path in this drawing (Inkscape: Path, Object to Path)");
  }
  std::vector<std::string_view> ids;
  for (const SvgElement& element : *all) {
    if (element.id == options.path_id) return std::vector<SvgElement>{element};
    if (!element.id.empty()) ids.push_back(element.id);
  }
  std::string hint = base::suggestion(options.path_id, ids);
  const bool is_near = !hint.empty();
  for (std::size_t i = 0; !is_near && i < std::min<std::size_t>(ids.size(), 10); ++i) {
    hint += (i == 0 ? "; there are " : ", ") + std::string(ids[i]);
  }
  return error_in(path, ErrorCode::unknown_name,
                  "there is no path '" + options.path_id + "'" + hint);
}

/// `wanted`, or with a number behind it where that is taken.
std::string free_name(const std::string& wanted, std::set<std::string>& taken) {
  std::string name = wanted;
  for (int i = 2; !taken.insert(name).second; ++i) name = wanted + "_" + std::to_string(i);
  return name;
}

/// What the curves of the path number `index` are called.
std::string base_name(const SvgElement& element, std::size_t index, const CurveOptions& options) {
  if (!options.name.empty()) return options.name;
  return curves::is_valid_name(element.id) ? element.id : "path_" + std::to_string(index + 1);
}

Result<void> add_curves(const SvgElement& element, const std::string& name,
                        const CurveOptions& options, std::set<std::string>& taken,
                        curves::CurveSet& set) {
  const auto y = options.y_down ? curves::SvgY::down : curves::SvgY::up;
  const auto drawn = curves::curves_from_svg_path(element.d, y);
  if (!drawn) {
    Error error = drawn.error();
    error.source = options.files.front();
    error.line = element.line;
    error.message = name + ": " + error.message;
    if (error.offset >= 0) error.message += " (byte " + std::to_string(error.offset) + " of its d)";
    error.offset = -1;
    return error;
  }
  if (set.curves.size() + drawn->size() > kMaxCurves) {
    return fail(ErrorCode::file_too_large,
                "more than " + std::to_string(kMaxCurves) + " curves; --path takes one path");
  }
  for (std::size_t i = 0; i < drawn->size(); ++i) {
    const std::string own = drawn->size() == 1 ? name : name + "_" + std::to_string(i + 1);
    auto named = renamed((*drawn)[i], free_name(own, taken));
    if (named && options.unit_square) named = curves::in_unit_square(*named);
    if (!named) return named.error();
    set.curves.push_back(*named);
  }
  return {};
}

}  // namespace

Result<Made> imported(const CurveOptions& options) {
  const std::string& path = options.files.front();
  const auto text = base::read_file(path, kMaxDrawingBytes);
  if (!text) return text.error();
  const auto elements = paths_of(*text, options);
  if (!elements) return elements.error();
  curves::CurveSet set;
  std::set<std::string> taken;
  for (std::size_t i = 0; i < elements->size(); ++i) {
    const SvgElement& element = (*elements)[i];
    const std::string name = base_name(element, i, options);
    if (const auto added = add_curves(element, name, options, taken, set); !added) {
      return told_of(path, added.error());
    }
    if (!element.is_transformed) continue;
    std::fprintf(stderr, "%s:%d: warning: the transform of '%s' is not applied\n", path.c_str(),
                 element.line, name.c_str());
  }
  const auto made = made_of(set);
  return made ? made : told_of(path, made.error());
}

Result<Made> exported(const CurveOptions& options) {
  const auto item = read_item(options.files.front());
  if (!item) return item.error();
  const auto* curve = std::get_if<NurbsCurve>(&*item);
  if (curve == nullptr) return fail(ErrorCode::usage, "export is for curves, this is a surface");
  const double largest = largest_value(*curve);
  const auto path = curves::svg_path_from_curve(*curve, tolerance_of(options, largest));
  if (!path) return told_of(options.files.front(), path.error());
  const bool is_place = curve->dim() == 2;
  const auto x = curves::value_range(*curve, 0), y = curves::value_range(*curve, is_place ? 1 : 0);
  const double left = is_place ? x.low.value : curve->u_min();
  const double right = is_place ? x.high.value : curve->u_max();
  const double width = right > left ? right - left : 1;
  const double height = y.high.value > y.low.value ? y.high.value - y.low.value : 1;
  const SvgFrame frame{left, -y.high.value, width, height};
  return Made{
      svg_drawing(curve->name(), path->d, frame),
      curve->name() + ": nowhere farther off than " + error_text(path->max_error, largest) + "\n"};
}

}  // namespace knotwave::curve_app
