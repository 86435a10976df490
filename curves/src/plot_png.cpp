// SPDX-License-Identifier: MIT
// Shapes to pixels, every edge with the share of the pixel it covers.
#include <algorithm>
#include <cmath>

#include "plot_scene.h"

namespace knotwave::curves {
namespace {

struct Box {
  int x0, y0, x1, y1;  // x1, y1 excluded
};

class Pixels {
 public:
  Pixels(int width, int height)
      : width_(width),
        height_(height),
        rgb_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3, 255.0) {}

  Box box_around(const std::vector<Point>& points, double margin) const {
    double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
    for (const Point& p : points) {
      x0 = std::min(x0, p.x);
      y0 = std::min(y0, p.y);
      x1 = std::max(x1, p.x);
      y1 = std::max(y1, p.y);
    }
    const auto bounded = [](double v, int top) {
      return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(top)));
    };
    return {bounded(std::floor(x0 - margin), width_), bounded(std::floor(y0 - margin), height_),
            bounded(std::ceil(x1 + margin) + 1, width_),
            bounded(std::ceil(y1 + margin) + 1, height_)};
  }

  void blend(int x, int y, Color color, double coverage) {
    const double share = std::clamp(coverage, 0.0, 1.0) * color.opacity;
    if (share <= 0) return;
    double* pixel = &rgb_[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                           static_cast<std::size_t>(x)) *
                          3];
    const double parts[] = {double(color.red), double(color.green), double(color.blue)};
    for (int i = 0; i < 3; ++i) pixel[i] += share * (parts[i] - pixel[i]);
  }

  std::vector<std::uint8_t> bytes() const {
    std::vector<std::uint8_t> out(rgb_.size());
    std::transform(rgb_.begin(), rgb_.end(), out.begin(),
                   [](double v) { return static_cast<std::uint8_t>(std::floor(v + 0.5)); });
    return out;
  }

 private:
  int width_, height_;
  std::vector<double> rgb_;
};

double distance_to_segment(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double length2 = dx * dx + dy * dy;
  const double along =
      length2 > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0) : 0.0;
  const double ex = p.x - (a.x + along * dx), ey = p.y - (a.y + along * dy);
  return std::sqrt(ex * ex + ey * ey);
}

// A line is one shape: where its segments meet, the pixel takes the larger cover, not both.
void draw_line(Pixels& pixels, const std::vector<Point>& points, Color color, double width) {
  if (points.empty() || width <= 0) return;
  const Box box = pixels.box_around(points, width + 1);
  const int columns = std::max(0, box.x1 - box.x0), rows = std::max(0, box.y1 - box.y0);
  std::vector<double> cover(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
                            0.0);
  const std::size_t segments = std::max<std::size_t>(points.size() - 1, 1);
  for (std::size_t i = 0; i < segments; ++i) {
    const Point a = points[i], b = points[std::min(i + 1, points.size() - 1)];
    const Box part = pixels.box_around({a, b}, width + 1);
    for (int y = part.y0; y < part.y1; ++y) {
      for (int x = part.x0; x < part.x1; ++x) {
        const double distance = distance_to_segment({x + 0.5, y + 0.5}, a, b);
        // Lines thinner than a pixel cover a part of it.
        const double full = std::min(width, 1.0);
        const double share = full * std::clamp(std::max(width, 1.0) / 2 + 0.5 - distance, 0.0, 1.0);
        double& kept =
            cover[static_cast<std::size_t>(y - box.y0) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(x - box.x0)];
        kept = std::max(kept, share);
      }
    }
  }
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      pixels.blend(box.x0 + x, box.y0 + y, color,
                   cover[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                         static_cast<std::size_t>(x)]);
    }
  }
}

// The parts of a line that its dashes leave.
std::vector<std::vector<Point>> dashes(const std::vector<Point>& points, double length) {
  std::vector<std::vector<Point>> parts;
  double left = length;
  bool drawn = true;
  std::vector<Point> part{points.front()};
  for (std::size_t i = 1; i < points.size(); ++i) {
    Point a = points[i - 1];
    const Point b = points[i];
    double rest = std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
    while (rest > left) {
      const double t = left / rest;
      a = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
      rest -= left;
      if (drawn) {
        part.push_back(a);
        parts.push_back(part);
      }
      drawn = !drawn;
      part = {a};
      left = length;
    }
    left -= rest;
    part.push_back(b);
  }
  if (drawn && part.size() > 1) parts.push_back(part);
  return parts;
}

// Even-odd filling; each pixel row by four lines, along x the exact cover.
void fill_area(Pixels& pixels, const std::vector<Point>& points, Color color) {
  constexpr int kLines = 4;
  const Box box = pixels.box_around(points, 1);
  std::vector<double> cover(static_cast<std::size_t>(std::max(0, box.x1 - box.x0)));
  for (int y = box.y0; y < box.y1; ++y) {
    std::fill(cover.begin(), cover.end(), 0.0);
    for (int line = 0; line < kLines; ++line) {
      const double at = y + (line + 0.5) / kLines;
      std::vector<double> crossings;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Point a = points[i], b = points[(i + 1) % points.size()];
        if ((a.y <= at) == (b.y <= at)) continue;
        crossings.push_back(a.x + (at - a.y) / (b.y - a.y) * (b.x - a.x));
      }
      std::sort(crossings.begin(), crossings.end());
      for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
        for (int x = box.x0; x < box.x1; ++x) {
          const double inside =
              std::min(crossings[i + 1], x + 1.0) - std::max(crossings[i], x + 0.0);
          if (inside > 0) cover[static_cast<std::size_t>(x - box.x0)] += inside / kLines;
        }
      }
    }
    for (int x = box.x0; x < box.x1; ++x) {
      pixels.blend(x, y, color, cover[static_cast<std::size_t>(x - box.x0)]);
    }
  }
}

void fill_disc(Pixels& pixels, Point middle, double radius, Color color) {
  const Box box = pixels.box_around({middle}, radius + 1);
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      const double distance = distance_to_segment({x + 0.5, y + 0.5}, middle, middle);
      pixels.blend(x, y, color, radius + 0.5 - distance);
    }
  }
}

void draw_text(Pixels& pixels, const Shape& shape) {
  const double width = text_width(shape.text, shape.size);
  const double shift = shape.anchor == Shape::Anchor::start    ? 0
                       : shape.anchor == Shape::Anchor::middle ? width / 2
                                                               : width;
  for (std::vector<Point> stroke : text_strokes(shape.text, shape.size)) {
    for (Point& p : stroke) {
      p.x += shape.points[0].x - shift;
      p.y += shape.points[0].y;
    }
    draw_line(pixels, stroke, shape.line, shape.size * (shape.bold ? 0.14 : 0.09));
  }
}

void draw(Pixels& pixels, const Shape& shape) {
  switch (shape.kind) {
    case Shape::Kind::line:
      if (shape.dash > 0) {
        for (const auto& part : dashes(shape.points, shape.dash)) {
          draw_line(pixels, part, shape.line, shape.width);
        }
      } else {
        draw_line(pixels, shape.points, shape.line, shape.width);
      }
      break;
    case Shape::Kind::area: {
      fill_area(pixels, shape.points, shape.fill);
      std::vector<Point> around = shape.points;
      around.push_back(shape.points.front());
      draw_line(pixels, around, shape.line, shape.width);
      break;
    }
    case Shape::Kind::disc:
      // The outline straddles the edge, as in SVG.
      if (shape.width > 0) {
        fill_disc(pixels, shape.points[0], shape.radius + shape.width / 2, shape.line);
      }
      fill_disc(pixels, shape.points[0], shape.radius - shape.width / 2, shape.fill);
      break;
    case Shape::Kind::text:
      draw_text(pixels, shape);
      break;
  }
}

}  // namespace

std::vector<std::uint8_t> png_of(const Scene& scene) {
  Pixels pixels(scene.width, scene.height);
  for (const Shape& shape : scene.shapes) draw(pixels, shape);
  return png_file(scene.width, scene.height, pixels.bytes());
}

}  // namespace knotwave::curves
