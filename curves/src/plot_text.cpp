// SPDX-License-Identifier: MIT
// Pictures for terminals: Braille dots, 2 by 4 to a character.
#include <algorithm>
#include <cmath>
#include <utility>

#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/plot.h"

#include "plot_axes.h"

namespace knotwave::curves {
namespace {

constexpr int kMargin = 10;  // columns for the numbers on the left

/// The two ends of an axis, told apart as far as the margin has room.
std::pair<std::string, std::string> end_texts(Range range) {
  const auto texts = tick_texts({range.low, range.high});
  if (std::max(texts[0].size(), texts[1].size()) < kMargin) return {texts[0], texts[1]};
  return {short_text(range.low), short_text(range.high)};
}

std::string padded(const std::string& text, std::size_t width) {
  return text.size() >= width ? text : std::string(width - text.size(), ' ') + text;
}

std::string utf8(unsigned code) {
  return {static_cast<char>(0xe0 | (code >> 12)), static_cast<char>(0x80 | ((code >> 6) & 63)),
          static_cast<char>(0x80 | (code & 63))};
}

// Dots of a raster, drawn as Braille characters (Unicode 2800..28FF).
class Dots {
 public:
  Dots(int columns, int rows)
      : columns_(columns),
        rows_(rows),
        cells_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0) {}

  void line(Point a, Point b) {
    const int steps = std::max(
        1, static_cast<int>(std::ceil(std::max(std::abs(b.x - a.x), std::abs(b.y - a.y)))));
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      dot(static_cast<int>(std::floor(a.x + t * (b.x - a.x) + 0.5)),
          static_cast<int>(std::floor(a.y + t * (b.y - a.y) + 0.5)));
    }
  }

  std::string row(int y) const {
    std::string text;
    for (int x = 0; x < columns_; ++x) {
      const unsigned cell = cells_[index_of(x, y)];
      text += cell == 0 ? " " : utf8(0x2800 + cell);
    }
    return text;
  }

 private:
  void dot(int x, int y) {
    if (x < 0 || y < 0 || x >= 2 * columns_ || y >= 4 * rows_) return;
    constexpr unsigned kBits[4][2] = {{1, 8}, {2, 16}, {4, 32}, {64, 128}};
    cells_[index_of(x / 2, y / 4)] |= kBits[y % 4][x % 2];
  }

  std::size_t index_of(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  int columns_, rows_;
  std::vector<unsigned> cells_;
};

void draw_spans(Dots& dots, const Frame& frame, const NurbsCurve& curve,
                const std::vector<SpanSamples>& spans, int x, int y) {
  const auto dim = static_cast<std::size_t>(curve.dim());
  for (const SpanSamples& span : spans) {
    const auto at = [&](std::size_t k) {
      const auto value = [&](int c) {
        return c < 0 ? span.u[k] : span.values[k * dim + static_cast<std::size_t>(c)];
      };
      return frame.at(value(x), value(y));
    };
    for (std::size_t k = 1; k < span.u.size(); ++k) dots.line(at(k - 1), at(k));
  }
}

// The line under the picture: a mark where a knot is, a double one where several are.
std::string knot_line(const NurbsCurve& curve, int columns, bool plane) {
  std::vector<std::string> line(static_cast<std::size_t>(columns), "─");
  for (const KnotMark& mark : knot_marks(curve)) {
    if (plane) break;
    const double share = (mark.u - curve.u_min()) / (curve.u_max() - curve.u_min());
    const auto at = static_cast<std::size_t>(std::floor(share * (columns - 1) + 0.5));
    line[at] = mark.multiplicity > 1 ? "╨" : "┴";
  }
  std::string text;
  for (const std::string& part : line) text += part;
  return text;
}

}  // namespace

std::string plot_text(const NurbsCurve& curve, int columns, int rows) {
  const int inner = std::max(16, columns - kMargin - 1), high = std::max(4, rows - 2);
  const bool plane = curve.dim() == 2;
  const auto spans = sample_spans(curve, 4 * inner);
  Frame frame;
  frame.right = 2 * inner - 1.0;
  frame.bottom = 4 * high - 1.0;
  frame.x = plane ? widened(range_of(spans, 2, 0)) : Range{curve.u_min(), curve.u_max()};
  frame.y = range_of(spans, curve.dim(), plane ? 1 : 0);
  for (int c = 1; c < curve.dim() && !plane; ++c) {
    const Range more = range_of(spans, curve.dim(), c);
    frame.y.include(more.low);
    frame.y.include(more.high);
  }
  frame.y = widened(frame.y);
  Dots dots(inner, high);
  if (plane) {
    draw_spans(dots, frame, curve, spans, 0, 1);
  } else {
    for (int c = 0; c < curve.dim(); ++c) draw_spans(dots, frame, curve, spans, -1, c);
  }
  const auto up = end_texts(frame.y), across = end_texts(frame.x);
  std::string text = curve.name() + "  " + description_of(curve) + "\n";
  for (int y = 0; y < high; ++y) {
    const std::string number = y == 0 ? up.second : y == high - 1 ? up.first : "";
    text += padded(number, kMargin - 1) + " │" + dots.row(y) + "\n";
  }
  text += std::string(kMargin, ' ') + "└" + knot_line(curve, inner, plane) + "\n";
  text += std::string(kMargin + 1, ' ') + across.first +
          padded(across.second, static_cast<std::size_t>(inner) - across.first.size()) + "\n";
  return text;
}

std::string plot_text(const NurbsSurface& surface, int columns, int rows) {
  const int inner = std::max(16, columns - kMargin - 1), high = std::max(4, rows - 2);
  std::vector<double> values;
  for (int y = 0; y < high; ++y) {
    for (int x = 0; x < inner; ++x) {
      double value[kMaxDim];
      const double u = surface.u_min() + (surface.u_max() - surface.u_min()) * x / (inner - 1);
      const double v = surface.v_max() - (surface.v_max() - surface.v_min()) * y / (high - 1);
      surface.evaluate(u, v, value);
      values.push_back(value[surface.dim() >= 3 ? 2 : 0]);
    }
  }
  const auto [low, top] = std::minmax_element(values.begin(), values.end());
  const double size = *top > *low ? *top - *low : 1;
  const char* shades[] = {" ", "░", "▒", "▓", "█"};
  std::string text = surface.name() + "  light " + short_text(*low) + " to dark " +
                     short_text(*top) + ", v up, u across\n";
  for (int y = 0; y < high; ++y) {
    const double v = y == 0 ? surface.v_max() : surface.v_min();
    const std::size_t row_start = static_cast<std::size_t>(y) * static_cast<std::size_t>(inner);
    text += padded(y == 0 || y == high - 1 ? short_text(v) : "", kMargin - 1) + " │";
    for (int x = 0; x < inner; ++x) {
      const double share = (values[row_start + static_cast<std::size_t>(x)] - *low) / size;
      text += shades[std::min(4, static_cast<int>(share * 5))];
    }
    text += "\n";
  }
  const std::string first = short_text(surface.u_min()), last = short_text(surface.u_max());
  text += std::string(kMargin, ' ') + "└" +
          knot_line(surface.iso_curve_at_v(surface.v_min()), inner, false) + "\n";
  text += std::string(kMargin + 1, ' ') + first +
          padded(last, static_cast<std::size_t>(inner) - first.size()) + "\n";
  return text;
}

}  // namespace knotwave::curves
