// SPDX-License-Identifier: MIT
// A picture as an SVG file: lines, areas, dots, words. Pixels from the upper left.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "knotwave/base/result.h"

namespace gallery {

struct Point {
  double x = 0;
  double y = 0;
};
Point mix(Point a, Point b, double t);

inline constexpr const char* kInk = "#222831";
inline constexpr const char* kSoft = "#8a94a0";
inline constexpr const char* kFaint = "#e3e7ec";
inline constexpr const char* kOrange = "#f47b20";
inline constexpr const char* kHues[] = {"#0a5cd6", "#8a3ffc", "#d12771", "#f47b20",
                                        "#e0a800", "#00875a", "#007d99"};

/// From blue over violet and red to orange, t = 0..1.
std::string hue(double t);

struct Stroke {
  std::string color = kInk;
  double width = 1;
  double opacity = 1;
  double dash = 0;  ///< > 0: dashes this long
};

struct Words {
  double size = 13;
  std::string color = kInk;
  std::string anchor = "start";  ///< or "middle", "end"
  bool bold = false;
};

class Picture {
 public:
  /// Title and one line below it; the drawing begins at y = kTop.
  Picture(int width, int height, const std::string& title, const std::string& words);
  static constexpr double kTop = 84;

  void line(std::span<const Point> points, const Stroke& stroke);
  void line(Point from, Point to, const Stroke& stroke);
  void area(std::span<const Point> points, const std::string& fill, double opacity = 1,
            const Stroke& outline = {.width = 0});
  void dot(Point at, double radius, const std::string& fill);  ///< with a white rim
  void text(Point at, const std::string& text, const Words& words = {});
  knotwave::Result<void> save(const std::string& path) const;

 private:
  void path(std::span<const Point> points, const std::string& end);
  std::string svg_;
};

/// A rectangle of pixels with 0..1 (or more) along each side.
struct Frame {
  double left, top, right, bottom;
  double x_low = 0, x_high = 1, y_low = 0, y_high = 1;

  Point at(double x, double y) const {
    return {left + (x - x_low) / (x_high - x_low) * (right - left),
            bottom - (y - y_low) / (y_high - y_low) * (bottom - top)};
  }
  /// Its floor, and lines at y_low and y_high.
  void draw(Picture& picture) const;
};

}  // namespace gallery
