// SPDX-License-Identifier: MIT
// The frame of a plot: ranges, round tick values, and what is where in pixels.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "knotwave/curves/nurbs_curve.h"

#include "plot_scene.h"

namespace knotwave::curves {

/// The colours of a plot.
inline constexpr Color kInk{34, 40, 49};
inline constexpr Color kFaint{225, 229, 234};
inline constexpr Color kAxis{120, 130, 142};
inline constexpr Color kPolygon{150, 158, 168};
inline constexpr Color kPoint{244, 123, 32};
inline constexpr Color kWhite{255, 255, 255};
inline constexpr Color kCurves[] = {{10, 92, 214}, {206, 33, 96}, {0, 138, 98}, {126, 63, 190}};

struct Range {
  double low = 0;
  double high = 1;
  double size() const { return high - low; }
  void include(double value);
};

/// Multiples of 1, 2 or 5 times a power of ten inside `range`, about `count` of them.
std::vector<double> round_ticks(Range range, int count);
/// Short text of a weight: up to 4 significant digits.
std::string short_text(double value);
/// Texts of ticks: 4 significant digits, or as many as tell neighbours apart, to 1 % of their
/// distance.
std::vector<std::string> tick_texts(const std::vector<double>& ticks);

/// `text` if it is at most `width` pixels wide, else its beginning and "...".
std::string fitted(const std::string& text, double size, double width);
/// A bold name at the left and, as far as there is room, a description at the right.
void draw_title(Scene& scene, double left, double right, double y, const std::string& name,
                const std::string& description);

/// A rectangle of pixels with a range along each side.
struct Frame {
  double left = 0, top = 0, right = 0, bottom = 0;
  Range x, y;

  Point at(double value_x, double value_y) const {
    return {left + (value_x - x.low) / x.size() * (right - left),
            bottom - (value_y - y.low) / y.size() * (bottom - top)};
  }
  bool holds(Point point) const;
  /// Pixels that the numbers beside the left edge need.
  double width_of_numbers() const;
  /// Grid, numbers and names of the axes.
  void draw(Scene& scene, const std::string& x_name, const std::string& y_name) const;

 private:
  std::vector<double> ticks_across() const;  ///< as many as have room for their numbers
  std::vector<double> ticks_up() const;
};

/// The curve between two knots, at least `steps` lines, left limit at the end. [dim] numbers each.
struct SpanSamples {
  double u0 = 0, u1 = 1;
  std::vector<double> u;
  std::vector<double> values;  ///< [u.size() * dim]
};
/// Every span of positive length; `steps` is for the whole curve.
std::vector<SpanSamples> sample_spans(const NurbsCurve& curve, int steps);

/// What a coordinate covers in the samples; widened when it is (nearly) constant.
Range range_of(const std::vector<SpanSamples>& spans, int dim, int coordinate);
Range widened(Range range);

/// A knot inside or at the ends of the domain and how often it is there.
struct KnotMark {
  double u = 0;
  int multiplicity = 1;
};
std::vector<KnotMark> knot_marks(const NurbsCurve& curve);

/// "degree 3, rational, 5 points, periodic".
std::string description_of(const NurbsCurve& curve);

}  // namespace knotwave::curves
