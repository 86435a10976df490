// SPDX-License-Identifier: MIT
// Values over time as a picture: lines, and steps over them. [control]
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "knotwave/curves/plot.h"

namespace knotwave::curves {

struct PlotTrace {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< (x, y), x does not decrease
  bool is_steps = false;  ///< a value holds until the next one; drawn over the lines
};

/// Traces over one another, with axes.
struct PlotPanel {
  std::string title;
  std::string y_name;
  std::vector<PlotTrace> traces;
};

/// Panels below one another with one range of x. The height of `options` is that of each panel;
/// what is not finite is left out.
std::string plot_svg(const std::vector<PlotPanel>& panels, std::string_view x_name,
                     const PlotOptions& options = {});

}  // namespace knotwave::curves
