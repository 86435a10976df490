// SPDX-License-Identifier: MIT
#include "plot_axes.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace knotwave::curves {
namespace {

constexpr double kTickSize = 13;
constexpr double kRightMargin = 24;  // of the page, for half a number

/// How much too far to the right a number of that width would reach under the right edge.
double overhang(double width) { return std::max(0.0, width / 2 - kRightMargin); }

double widest(const std::vector<std::string>& texts) {
  double width = 0;
  for (const std::string& text : texts) width = std::max(width, text_width(text, kTickSize));
  return width;
}

}  // namespace

void Range::include(double value) {
  low = std::min(low, value);
  high = std::max(high, value);
}

std::vector<double> round_ticks(Range range, int count) {
  double step = 1;
  while (step * count < range.size()) step *= 10;
  while (step * count > range.size() * 10) step /= 10;
  // step is now a power of ten with at least 1 and less than 10 times too few ticks.
  if (range.size() / (step / 5) <= count) {
    step /= 5;
  } else if (range.size() / (step / 2) <= count) {
    step /= 2;
  }
  std::vector<double> ticks;
  for (double i = std::ceil(range.low / step - 1e-9); i * step <= range.high + 1e-9 * step; ++i) {
    ticks.push_back(i * step);
  }
  return ticks;
}

std::string short_text(double value) {
  char text[32];
  const double rounded = std::abs(value) < 1e-12 ? 0.0 : value;
  const auto end =
      std::to_chars(text, text + sizeof text, rounded, std::chars_format::general, 4).ptr;
  return {text, end};
}

std::vector<std::string> tick_texts(const std::vector<double>& ticks) {
  const double step = ticks.size() > 1 ? std::abs(ticks[1] - ticks[0]) : 0;
  std::vector<std::string> texts(ticks.size());
  for (int digits = 4; digits <= 17; ++digits) {
    bool is_exact = true;
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      const double value = std::abs(ticks[i]) < 1e-6 * step ? 0.0 : ticks[i];
      char text[32];
      const auto end =
          std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr;
      texts[i].assign(text, end);
      double read = 0;
      std::from_chars(text, end, read);
      is_exact = is_exact && std::abs(read - value) <= 0.01 * step;
    }
    if (is_exact || step == 0) break;
  }
  return texts;
}

std::string fitted(const std::string& text, double size, double width) {
  if (text_width(text, size) <= width) return text;
  std::string cut = text;
  while (!cut.empty() && text_width(cut + "...", size) > width) cut.pop_back();
  return cut.empty() ? "" : cut + "...";
}

void draw_title(Scene& scene, double left, double right, double y, const std::string& name,
                const std::string& description) {
  constexpr double kNameSize = 20, kSize = 14, kGap = 24, kEdge = 16;
  constexpr double kBoldness = 1.1;  // bold letters are wider by as much, nearly
  const double words = text_width(description, kSize);
  const double letters = kBoldness * text_width(name, kNameSize);
  if (letters + words + kGap > right - left) left = std::min(left, kEdge);
  const double room = right - left - kGap;
  // A long name has what the description leaves, but at least two fifths.
  const double name_room = letters <= 0.6 * room ? letters : std::max(0.4 * room, room - words);
  const std::string shown = fitted(name, kNameSize, name_room / kBoldness);
  scene.text({left, y}, shown, kInk, kNameSize, Shape::Anchor::start, true);
  const double rest = room - kBoldness * text_width(shown, kNameSize);
  const std::string about = fitted(description, kSize, rest);
  if (!about.empty()) scene.text({right, y}, about, kAxis, kSize, Shape::Anchor::end);
}

bool Frame::holds(Point point) const {
  return point.x >= left - 1 && point.x <= right + 1 && point.y >= top - 1 && point.y <= bottom + 1;
}

std::vector<double> Frame::ticks_up() const {
  return round_ticks(y, std::clamp(static_cast<int>((bottom - top) / 24), 2, 8));
}

std::vector<double> Frame::ticks_across() const {
  for (int count = 10; count > 2; --count) {
    std::vector<double> ticks = round_ticks(x, count);
    if (ticks.size() < 2) return ticks;
    const double distance = at(ticks[1], y.low).x - at(ticks[0], y.low).x;
    const double width = widest(tick_texts(ticks));
    if (width + 10 + overhang(width) <= distance) return ticks;
  }
  return round_ticks(x, 2);
}

double Frame::width_of_numbers() const { return widest(tick_texts(ticks_up())); }

void Frame::draw(Scene& scene, const std::string& x_name, const std::string& y_name) const {
  const std::vector<double> across = ticks_across();
  const std::vector<std::string> across_texts = tick_texts(across);
  for (std::size_t i = 0; i < across.size(); ++i) {
    const Point foot = at(across[i], y.low);
    scene.line({{foot.x, top}, {foot.x, bottom}}, kFaint, 1);
    const double most = right - overhang(text_width(across_texts[i], kTickSize));
    scene.text({std::min(foot.x, most), bottom + 30}, across_texts[i], kInk, kTickSize,
               Shape::Anchor::middle);
  }
  const std::vector<double> up = ticks_up();
  const std::vector<std::string> up_texts = tick_texts(up);
  for (std::size_t i = 0; i < up.size(); ++i) {
    const Point foot = at(x.low, up[i]);
    const bool zero = up[i] == 0 && y.low < 0;
    scene.line({{left, foot.y}, {right, foot.y}}, zero ? kAxis : kFaint, 1);
    scene.text({left - 10, foot.y + 4.5}, up_texts[i], kInk, kTickSize, Shape::Anchor::end);
  }
  scene.line({{left, bottom}, {right, bottom}}, kAxis, 1.2);
  scene.line({{left, top}, {left, bottom}}, kAxis, 1.2);
  scene.text({right, bottom + 47}, x_name, kInk, 14, Shape::Anchor::end, true);
  scene.text({left, top - 12}, y_name, kInk, 14, Shape::Anchor::middle, true);
}

std::vector<SpanSamples> sample_spans(const NurbsCurve& curve, int steps) {
  const auto knots = curve.knots();
  const double whole = curve.u_max() - curve.u_min();
  const auto dim = static_cast<std::size_t>(curve.dim());
  std::vector<SpanSamples> spans;
  for (int i = curve.degree(); i < curve.point_count(); ++i) {
    SpanSamples span;
    span.u0 = knots[static_cast<std::size_t>(i)];
    span.u1 = knots[static_cast<std::size_t>(i) + 1];
    if (!(span.u0 < span.u1)) continue;
    const int count =
        std::max(24, static_cast<int>(std::ceil(steps * (span.u1 - span.u0) / whole)));
    span.values.resize((static_cast<std::size_t>(count) + 1) * dim);
    for (int k = 0; k <= count; ++k) {
      const double u = k == count ? span.u1 : span.u0 + (span.u1 - span.u0) * k / count;
      span.u.push_back(u);
      curve.evaluate(u, k == count ? Side::left : Side::right,
                     std::span(span.values).subspan(static_cast<std::size_t>(k) * dim, dim));
    }
    spans.push_back(std::move(span));
  }
  return spans;
}

Range range_of(const std::vector<SpanSamples>& spans, int dim, int coordinate) {
  const auto step = static_cast<std::size_t>(dim), c = static_cast<std::size_t>(coordinate);
  Range range{spans[0].values[c], spans[0].values[c]};
  for (const SpanSamples& span : spans) {
    for (std::size_t i = c; i < span.values.size(); i += step) range.include(span.values[i]);
  }
  return range;
}

Range widened(Range range) {
  if (range.size() > 1e-9 * std::abs(range.high)) return range;
  const double room = std::max(0.5, 0.1 * std::abs(range.high));
  return {range.low - room, range.high + room};
}

std::vector<KnotMark> knot_marks(const NurbsCurve& curve) {
  std::vector<KnotMark> marks;
  for (const double knot : curve.knots()) {
    if (knot < curve.u_min() || knot > curve.u_max()) continue;
    if (!marks.empty() && marks.back().u == knot) {
      ++marks.back().multiplicity;
    } else {
      marks.push_back({knot, 1});
    }
  }
  return marks;
}

std::string description_of(const NurbsCurve& curve) {
  const auto written = curve.point_count() - (curve.is_periodic() ? curve.degree() : 0);
  std::string text = "degree " + std::to_string(curve.degree());
  if (curve.is_rational()) text += ", rational";
  text += ", " + std::to_string(written) + " points";
  if (curve.is_periodic()) text += ", periodic";
  if (!curve.is_periodic() && !curve.is_clamped()) text += ", unclamped";
  if (!curve.jumps().empty())
    text += ", " + std::to_string(curve.jumps().size()) + " jump" +
            (curve.jumps().size() == 1 ? "" : "s");
  return text;
}

}  // namespace knotwave::curves
