// SPDX-License-Identifier: MIT
// The paths of an SVG drawing, and a drawing of one path.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/base/result.h"

namespace knotwave::curve_app {

struct SvgElement {
  std::string id;  ///< empty if it has none
  std::string d;
  int line = 0;                 ///< where the element begins, from 1
  bool is_transformed = false;  ///< it or a group around it has a transform, which is not applied
};

/// Every <path> with a d, in order. What is not XML in well-formed tags is malformed, with its
/// line; of entities &amp; &lt; &gt; &quot; &apos; and numbers of ASCII are read.
Result<std::vector<SvgElement>> svg_paths(std::string_view text, const std::string& source);

/// A corner of the drawing and its size, in the drawing's unit (y downwards).
struct SvgFrame {
  double x = 0, y = 0, width = 1, height = 1;
};
std::string svg_drawing(std::string_view id, std::string_view d, const SvgFrame& frame);

}  // namespace knotwave::curve_app
