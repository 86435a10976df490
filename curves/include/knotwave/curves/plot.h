// SPDX-License-Identifier: MIT
// A curve as a picture a musician can read: curve, control polygon, knots, weights; a surface as a
// shaded grid. [control]
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "knotwave/curves/nurbs_curve.h"
#include "knotwave/curves/nurbs_surface.h"
#include "knotwave/curves/trim_region.h"

namespace knotwave::curves {

struct PlotOptions {
  int width_px = 960;
  int height_px = 540;
  bool control_polygon = true;
  bool knots = true;
  bool weights = true;
};

std::string plot_svg(const NurbsCurve& curve, const PlotOptions& options = {});
std::string plot_svg(const NurbsSurface& surface, const PlotOptions& options = {});
/// The same picture as PNG bytes.
std::vector<std::uint8_t> plot_png(const NurbsCurve& curve, const PlotOptions& options = {});
std::vector<std::uint8_t> plot_png(const NurbsSurface& surface, const PlotOptions& options = {});
/// What a region of the (u, v) plane keeps of a surface, with its borders.
std::string plot_svg(const NurbsSurface& surface, const TrimRegion& kept,
                     const PlotOptions& options = {});
std::vector<std::uint8_t> plot_png(const NurbsSurface& surface, const TrimRegion& kept,
                                   const PlotOptions& options = {});
/// For a terminal, in UTF-8: a line of text, then `rows` lines of `columns` characters. A curve in
/// Braille dots with its knots below it, a surface as shades of its height.
std::string plot_text(const NurbsCurve& curve, int columns = 72, int rows = 14);
std::string plot_text(const NurbsSurface& surface, int columns = 72, int rows = 14);

}  // namespace knotwave::curves
