// SPDX-License-Identifier: MIT
#include "plot_scene.h"

#include <charconv>
#include <utility>

namespace knotwave::curves {
namespace {

// Pixels to a tenth: enough for the eye, and the same text everywhere.
std::string pixels(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, 1).ptr;
  std::string digits(text, end);
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
  return digits == "-0" ? "0" : digits;
}

std::string hex(Color color) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text = "#";
  for (const std::uint8_t part : {color.red, color.green, color.blue}) {
    text += kDigits[part >> 4];
    text += kDigits[part & 15];
  }
  return text;
}

std::string paint(const char* what, Color color) {
  std::string text = std::string(" ") + what + "=\"" + hex(color) + "\"";
  if (color.opacity < 1) {
    text += std::string(" ") + what + "-opacity=\"" + pixels(color.opacity) + "\"";
  }
  return text;
}

std::string outline(const Shape& shape) {
  if (shape.width <= 0) return "";
  std::string text = paint("stroke", shape.line) + " stroke-width=\"" + pixels(shape.width) + "\"";
  if (shape.dash > 0) text += " stroke-dasharray=\"" + pixels(shape.dash) + "\"";
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string element(const Shape& shape) {
  const Point at = shape.points.empty() ? Point{} : shape.points.front();
  switch (shape.kind) {
    case Shape::Kind::line:
    case Shape::Kind::area: {
      std::string path;
      for (const Point& point : shape.points) {
        path += (path.empty() ? "M" : " ") + pixels(point.x) + "," + pixels(point.y);
      }
      const bool area = shape.kind == Shape::Kind::area;
      return "<path d=\"" + path + (area ? "Z\"" : "\"") +
             (area ? paint("fill", shape.fill) : std::string(" fill=\"none\"")) + outline(shape) +
             "/>";
    }
    case Shape::Kind::disc:
      return "<circle cx=\"" + pixels(at.x) + "\" cy=\"" + pixels(at.y) + "\" r=\"" +
             pixels(shape.radius) + "\"" + paint("fill", shape.fill) + outline(shape) + "/>";
    case Shape::Kind::text: {
      const char* anchors[] = {"start", "middle", "end"};
      return "<text x=\"" + pixels(at.x) + "\" y=\"" + pixels(at.y) + "\" font-size=\"" +
             pixels(shape.size) + "\" text-anchor=\"" + anchors[static_cast<int>(shape.anchor)] +
             "\"" + (shape.bold ? " font-weight=\"bold\"" : "") + paint("fill", shape.line) + ">" +
             escaped(shape.text) + "</text>";
    }
  }
  return "";
}

}  // namespace

void Scene::line(std::vector<Point> points, Color color, double line_width, double dash) {
  Shape shape;
  shape.kind = Shape::Kind::line;
  shape.points = std::move(points);
  shape.line = color;
  shape.width = line_width;
  shape.dash = dash;
  shapes.push_back(std::move(shape));
}

void Scene::area(std::vector<Point> points, Color fill, Color outline_color, double line_width) {
  Shape shape;
  shape.kind = Shape::Kind::area;
  shape.points = std::move(points);
  shape.fill = fill;
  shape.line = outline_color;
  shape.width = line_width;
  shapes.push_back(std::move(shape));
}

void Scene::disc(Point middle, double radius, Color fill, Color outline_color, double line_width) {
  Shape shape;
  shape.kind = Shape::Kind::disc;
  shape.points = {middle};
  shape.radius = radius;
  shape.fill = fill;
  shape.line = outline_color;
  shape.width = line_width;
  shapes.push_back(std::move(shape));
}

void Scene::text(Point at, std::string words, Color color, double size, Shape::Anchor anchor,
                 bool bold) {
  Shape shape;
  shape.kind = Shape::Kind::text;
  shape.points = {at};
  shape.text = std::move(words);
  shape.line = color;
  shape.size = size;
  shape.anchor = anchor;
  shape.bold = bold;
  shapes.push_back(std::move(shape));
}

std::string svg_of(const Scene& scene) {
  const std::string width = std::to_string(scene.width), height = std::to_string(scene.height);
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "\" height=\"" + height +
      "\" viewBox=\"0 0 " + width + " " + height +
      "\" font-family=\"Helvetica, Arial, sans-serif\" stroke-linejoin=\"round\">\n<title>" +
      escaped(scene.title) + "</title>\n<rect width=\"" + width + "\" height=\"" + height +
      "\" fill=\"#ffffff\"/>\n";
  for (const Shape& shape : scene.shapes) svg += element(shape) + "\n";
  return svg + "</svg>\n";
}

}  // namespace knotwave::curves
