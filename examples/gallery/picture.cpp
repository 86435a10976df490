// SPDX-License-Identifier: MIT
#include "picture.h"

#include <array>
#include <charconv>
#include <cmath>

#include "knotwave/base/file.h"

namespace gallery {
namespace {

/// Two digits after the point, whatever the locale.
std::string number(double x) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::fixed, 2);
  return {text.data(), end.ptr};
}

std::string attributes(const Stroke& stroke) {
  std::string text =
      " stroke=\"" + stroke.color + "\" stroke-width=\"" + number(stroke.width) + '"';
  if (stroke.opacity < 1) text += " stroke-opacity=\"" + number(stroke.opacity) + '"';
  if (stroke.dash > 0) text += " stroke-dasharray=\"" + number(stroke.dash) + '"';
  return text;
}

}  // namespace

Point mix(Point a, Point b, double t) { return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}; }

std::string hue(double t) {
  constexpr std::array<std::array<double, 3>, 4> kStops = {
      {{10, 92, 214}, {126, 63, 220}, {214, 40, 110}, {244, 123, 32}}};
  const double at = std::fmin(std::fmax(t, 0), 1) * (kStops.size() - 1);
  const auto i = static_cast<std::size_t>(std::fmin(at, kStops.size() - 2));
  std::string text = "rgb(";
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = kStops[i][c] + (at - double(i)) * (kStops[i + 1][c] - kStops[i][c]);
    text += std::to_string(std::lround(value)) + (c < 2 ? "," : ")");
  }
  return text;
}

Picture::Picture(int width, int height, const std::string& title, const std::string& words) {
  const std::string w = std::to_string(width), h = std::to_string(height);
  svg_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h +
         "\" viewBox=\"0 0 " + w + ' ' + h +
         "\" font-family=\"DejaVu Sans, Verdana, sans-serif\" " +
         "fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n<title>" + title +
         "</title>\n<rect width=\"" + w + "\" height=\"" + h + "\" fill=\"#fdfdfb\"/>\n";
  text({32, 42}, title, {.size = 22, .bold = true});
  text({32, 66}, words, {.size = 14, .color = "#5b6570"});
}

void Picture::path(std::span<const Point> points, const std::string& end) {
  svg_ += "<path d=\"M";
  for (const Point& point : points) svg_ += ' ' + number(point.x) + ',' + number(point.y);
  svg_ += end;
}

void Picture::line(std::span<const Point> points, const Stroke& stroke) {
  path(points, '"' + attributes(stroke) + "/>\n");
}

void Picture::line(Point from, Point to, const Stroke& stroke) {
  line(std::array{from, to}, stroke);
}

void Picture::area(std::span<const Point> points, const std::string& fill, double opacity,
                   const Stroke& outline) {
  std::string end = " Z\" fill=\"" + fill + '"';
  if (opacity < 1) end += " fill-opacity=\"" + number(opacity) + '"';
  if (outline.width > 0) end += attributes(outline);
  path(points, end + "/>\n");
}

void Picture::dot(Point at, double radius, const std::string& fill) {
  svg_ += "<circle cx=\"" + number(at.x) + "\" cy=\"" + number(at.y) + "\" r=\"" + number(radius) +
          "\" fill=\"" + fill + "\" stroke=\"#ffffff\" stroke-width=\"1.6\"/>\n";
}

void Picture::text(Point at, const std::string& text, const Words& words) {
  svg_ += "<text x=\"" + number(at.x) + "\" y=\"" + number(at.y) + "\" font-size=\"" +
          number(words.size) + "\" fill=\"" + words.color + "\" text-anchor=\"" + words.anchor +
          (words.bold ? "\" font-weight=\"bold\">" : "\">") + text + "</text>\n";
}

knotwave::Result<void> Picture::save(const std::string& path) const {
  return knotwave::base::write_file(path, svg_ + "</svg>\n");
}

void Frame::draw(Picture& picture) const {
  picture.line({left, top}, {right, top}, {.color = kFaint});
  picture.line({left, bottom}, {right, bottom}, {.color = kSoft});
}

}  // namespace gallery
