// SPDX-License-Identifier: MIT
#include "curve_output.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>
#include <utility>

#include "knotwave/base/elementary.h"
#include "knotwave/curves/analysis.h"
#include "knotwave/engine/bank.h"

#include "command_line/places.h"
#include "curve_input.h"

namespace knotwave::curve_app {
namespace {

using base::number_text;
using curves::NurbsCurve;
using curves::NurbsSurface;

std::string digits(double value, std::chars_format format, int precision) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value, format, precision).ptr};
}

std::string line_of(const NurbsCurve& curve) {
  const auto count = curve.spec().points.size() / std::size_t(curve.dim());
  return curve.name() + ": degree " + std::to_string(curve.degree()) + ", " +
         std::to_string(count) + " points, u " + number_text(curve.u_min()) + " to " +
         number_text(curve.u_max()) + "\n";
}

std::string line_of(const NurbsSurface& surface) {
  const curves::SurfaceSpec spec = surface.spec();
  return surface.name() + ": degree " + std::to_string(spec.degree_u) + " x " +
         std::to_string(spec.degree_v) + ", " + std::to_string(spec.count_u) + " x " +
         std::to_string(spec.count_v) + " points, u " + number_text(surface.u_min()) + " to " +
         number_text(surface.u_max()) + ", v " + number_text(surface.v_min()) + " to " +
         number_text(surface.v_max()) + "\n";
}

Error no_name(const std::string& name) {
  return fail(ErrorCode::usage, "'" + name +
                                    "' would be a name of more than 64 letters, digits, '_' and "
                                    "'-'; --name NAME gives a shorter one");
}

}  // namespace

std::string output_overlap(const CurveOptions& options) {
  if (options.output.empty() || options.output == "-") return {};
  std::vector<command_line::NamedFile> inputs;
  for (const std::string& word : options.files) {
    const std::string path = reference_of(word).path;
    inputs.push_back({"the file that is read,", path});
    const auto file = read_known_file(path);
    if (!file || file->kind != curves::FileKind::patch) continue;
    const auto bank = engine::read_bank(path);
    if (!bank) continue;
    for (const auto& name : bank->files) inputs.push_back({"a file the patch names,", name});
  }
  const command_line::NamedFile output{"--output", options.output};
  return command_line::overlap(inputs, std::span(&output, 1));
}

Result<NurbsCurve> renamed(const NurbsCurve& curve, const std::string& name) {
  if (!curves::is_valid_name(name)) return no_name(name);
  curves::CurveSpec spec = curve.spec();
  spec.name = name;
  return NurbsCurve::create(std::move(spec));
}

Result<NurbsSurface> renamed(const NurbsSurface& surface, const std::string& name) {
  if (!curves::is_valid_name(name)) return no_name(name);
  curves::SurfaceSpec spec = surface.spec();
  spec.name = name;
  return NurbsSurface::create(std::move(spec));
}

Result<Made> made_of(const curves::CurveSet& set, const std::string& facts) {
  Made made{curves::write_curves(set), {}};
  if (made.text.size() > base::kMaxDocumentBytes) {
    return fail(ErrorCode::file_too_large,
                "the result takes " + std::to_string(made.text.size()) +
                    " bytes, more than the 1048576 a curve file may have");
  }
  for (const NurbsCurve& curve : set.curves) made.report += line_of(curve);
  for (const NurbsSurface& surface : set.surfaces) made.report += line_of(surface);
  if (!facts.empty()) made.report += facts + "\n";
  return made;
}

std::string error_text(double error, double largest) {
  if (error == 0) return "0";
  return digits(error, std::chars_format::general, 3) + " (" +
         digits(base::gain_to_db(error / largest), std::chars_format::fixed, 1) + " dB)";
}

double largest_value(const NurbsCurve& curve) {
  double largest = 0;
  for (int c = 0; c < curve.dim(); ++c) {
    const curves::ValueRange range = curves::value_range(curve, c);
    largest = std::max({largest, std::abs(range.low.value), std::abs(range.high.value)});
  }
  return largest > 0 ? largest : 1;
}

double tolerance_of(const CurveOptions& options, double largest) {
  return base::db_to_gain(options.within_db.value_or(kWithinDb)) * largest;
}

Error told_of(const std::string& source, Error error) {
  if (error.source.empty() && error.code != ErrorCode::usage) error.source = source;
  return error;
}

}  // namespace knotwave::curve_app
