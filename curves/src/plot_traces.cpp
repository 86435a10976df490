// SPDX-License-Identifier: MIT
#include "knotwave/curves/plot_traces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plot_axes.h"

namespace knotwave::curves {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

bool is_drawn(const std::pair<double, double>& point) {
  return std::isfinite(point.first) && std::isfinite(point.second);
}

template <class Number>
Range covered(const std::vector<PlotTrace>& traces, Number&& number) {
  Range range{kInfinite, -kInfinite};
  for (const PlotTrace& trace : traces) {
    for (const auto& point : trace.points) {
      if (is_drawn(point)) range.include(number(point));
    }
  }
  return range.low > range.high ? Range{0, 1} : range;
}

Range across(const std::vector<PlotPanel>& panels) {
  Range range{kInfinite, -kInfinite};
  for (const PlotPanel& panel : panels) {
    if (panel.traces.empty()) continue;
    const Range own = covered(panel.traces, [](const auto& point) { return point.first; });
    range.include(own.low);
    range.include(own.high);
  }
  return widened(range.low > range.high ? Range{0, 1} : range);
}

Range up(const PlotPanel& panel) {
  const Range range =
      widened(covered(panel.traces, [](const auto& point) { return point.second; }));
  return {range.low - 0.06 * range.size(), range.high + 0.06 * range.size()};
}

/// Pixels of a trace; of many that share a column only the first, the lowest, the highest and the
/// last.
std::vector<Point> pixels(const PlotTrace& trace, const Frame& frame) {
  std::vector<Point> all;
  for (const auto& point : trace.points) {
    if (!is_drawn(point)) continue;
    const Point at = frame.at(point.first, point.second);
    if (trace.is_steps && !all.empty()) all.push_back({at.x, all.back().y});
    all.push_back(at);
  }
  if (trace.is_steps && !all.empty()) all.push_back({frame.right, all.back().y});
  std::vector<Point> thin;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i;
    while (end < all.size() && std::floor(all[end].x * 2) == std::floor(all[i].x * 2)) ++end;
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(i);
    const auto last = all.begin() + static_cast<std::ptrdiff_t>(end);
    if (end - i <= 4) {
      thin.insert(thin.end(), first, last);
    } else {
      const auto [top, bottom] = std::minmax_element(
          first, last, [](const Point& a, const Point& b) { return a.y < b.y; });
      thin.insert(thin.end(),
                  {*first, *std::min(top, bottom), *std::max(top, bottom), *(last - 1)});
    }
    i = end;
  }
  return thin;
}

/// A trace's place among the colours: steps are drawn over the lines, and counted after them.
std::vector<Color> colors_of(const std::vector<PlotTrace>& traces) {
  std::vector<Color> colors(traces.size());
  std::size_t next = 0;
  for (const bool is_steps : {false, true}) {
    for (std::size_t i = 0; i < traces.size(); ++i) {
      if (traces[i].is_steps == is_steps) colors[i] = kCurves[next++ % std::size(kCurves)];
    }
  }
  return colors;
}

/// Names in the colours of their lines, up to the right edge. Gives what is left of them.
double draw_names(Scene& scene, const std::vector<PlotTrace>& traces,
                  const std::vector<Color>& colors, double left, double right, double y) {
  constexpr double kSize = 14, kGap = 24, kMostShare = 0.6;
  const double least = right - kMostShare * (right - left);
  for (std::size_t i = traces.size(); i-- > 0;) {
    const std::string name = fitted(traces[i].name, kSize, right - least);
    if (name.empty()) break;
    scene.text({right, y}, name, colors[i], kSize, Shape::Anchor::end);
    right -= text_width(name, kSize) + kGap;
  }
  return right;
}

void draw_panel(Scene& scene, const PlotPanel& panel, Frame frame, const std::string& x_name) {
  const std::vector<Color> colors = colors_of(panel.traces);
  const double y = frame.top - 36;
  const double right = draw_names(scene, panel.traces, colors, frame.left, frame.right, y);
  draw_title(scene, frame.left, right, y, panel.title, "");
  frame.draw(scene, x_name, panel.y_name);
  for (const bool is_steps : {false, true}) {
    for (std::size_t i = 0; i < panel.traces.size(); ++i) {
      if (panel.traces[i].is_steps != is_steps) continue;
      auto points = pixels(panel.traces[i], frame);
      if (points.size() > 1) scene.line(std::move(points), colors[i], is_steps ? 1.2 : 2.4);
    }
  }
}

}  // namespace

std::string plot_svg(const std::vector<PlotPanel>& panels, std::string_view x_name,
                     const PlotOptions& options) {
  Scene scene;
  scene.width = options.width_px;
  scene.height = options.height_px * std::max(static_cast<int>(panels.size()), 1);
  const Range x = across(panels);
  double top = 0;
  for (const PlotPanel& panel : panels) {
    scene.title += (scene.title.empty() ? "" : "; ") + panel.title;
    Frame frame;
    frame.x = x;
    frame.y = up(panel);
    frame.top = top + 66;
    frame.bottom = top + options.height_px - 62.0;
    frame.right = options.width_px - 28.0;
    frame.left = std::max(76.0, frame.width_of_numbers() + 22);
    draw_panel(scene, panel, frame, std::string(x_name));
    top += options.height_px;
  }
  return svg_of(scene);
}

}  // namespace knotwave::curves
