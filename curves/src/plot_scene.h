// SPDX-License-Identifier: MIT
// A picture as a list of shapes, drawn alike as SVG and as PNG.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace knotwave::curves {

struct Point {
  double x = 0;  ///< pixels from the left
  double y = 0;  ///< pixels from the top
};

struct Color {
  std::uint8_t red = 0, green = 0, blue = 0;
  double opacity = 1;
};

/// One shape. Lines and discs are outlines of `width` pixels in `line`, areas are filled.
struct Shape {
  enum class Kind { line, area, disc, text };
  enum class Anchor { start, middle, end };
  Kind kind = Kind::line;
  std::vector<Point> points;  ///< disc: its middle; text: its anchor on the base line
  Color line;                 ///< text: its colour
  Color fill;                 ///< area, disc
  double width = 1;           ///< of the line; 0 = no outline
  double dash = 0;            ///< > 0: dashes this long, gaps too
  double radius = 0;
  std::string text;  ///< ASCII
  double size = 12;  ///< height of text in pixels
  bool bold = false;
  Anchor anchor = Anchor::start;
};

struct Scene {
  int width = 0;
  int height = 0;
  std::string title;  ///< for readers that do not see the picture
  std::vector<Shape> shapes;

  void line(std::vector<Point> points, Color color, double width, double dash = 0);
  void area(std::vector<Point> points, Color fill, Color outline, double width);
  void disc(Point middle, double radius, Color fill, Color outline, double width);
  void text(Point at, std::string text, Color color, double size,
            Shape::Anchor anchor = Shape::Anchor::start, bool bold = false);
};

std::string svg_of(const Scene& scene);
std::vector<std::uint8_t> png_of(const Scene& scene);

/// Strokes of a text in pixels, from the left end of its base line. Our own plain letters on a grid
/// 6 high, lines only.
std::vector<std::vector<Point>> text_strokes(const std::string& text, double size);
double text_width(const std::string& text, double size);

/// 8-bit RGB, [width * height * 3] from the top left, as a PNG file.
std::vector<std::uint8_t> png_file(int width, int height, const std::vector<std::uint8_t>& rgb);

}  // namespace knotwave::curves
