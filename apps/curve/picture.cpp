// SPDX-License-Identifier: MIT
#include <span>
#include <vector>

#include "knotwave/base/file.h"
#include "knotwave/curves/plot.h"
#include "knotwave/engine/bank.h"

#include "command_line/places.h"
#include "curve_input.h"
#include "verbs.h"

namespace knotwave::curve_app {
namespace {

/// What is wrong with drawing over a file that is read; empty when nothing is.
std::string output_overlap(const CurveOptions& options) {
  const std::string path = reference_of(options.files.front()).path;
  std::vector<command_line::NamedFile> inputs = {{"the file of the curve", path}};
  const auto file = read_known_file(path);
  if (file && file->kind == curves::FileKind::patch) {
    const auto bank = engine::read_bank(path);
    if (bank) {
      for (const auto& name : bank->files) inputs.push_back({"a file the patch names,", name});
    }
  }
  const command_line::NamedFile output{"--output", options.output};
  return command_line::overlap(inputs, std::span(&output, 1));
}

}  // namespace

Result<std::string> plot_text_or_file(const CurveOptions& options) {
  const auto item = read_item(options.files.front());
  if (!item) return item.error();
  if (!options.output.empty()) {
    const std::string overlap = output_overlap(options);
    if (!overlap.empty()) return fail(ErrorCode::usage, overlap);
  }
  return std::visit(
      [&options](const auto& shape) -> Result<std::string> {
        if (options.output.empty()) return plot_text(shape, options.columns, options.rows);
        curves::PlotOptions plot;
        plot.width_px = options.width_px;
        plot.height_px = options.height_px;
        std::string bytes;
        if (base::has_ending(options.output, ".svg")) {
          bytes = plot_svg(shape, plot);
        } else {
          const auto png = plot_png(shape, plot);
          bytes.assign(png.begin(), png.end());
        }
        const auto written = base::write_file(options.output, bytes);
        if (!written) return written.error();
        return options.output + ": " + shape.name() + ", " + std::to_string(options.width_px) +
               " x " + std::to_string(options.height_px) + "\n";
      },
      *item);
}

}  // namespace knotwave::curve_app
