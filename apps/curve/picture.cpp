// SPDX-License-Identifier: MIT
#include "knotwave/base/file.h"
#include "knotwave/curves/plot.h"

#include "curve_input.h"
#include "curve_output.h"
#include "verbs.h"

namespace knotwave::curve_app {
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
