// SPDX-License-Identifier: MIT
#include "knotwave/curves/plot.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/index.h"
#include "knotwave/curves/algorithms.h"

#include "plot_axes.h"
#include "plot_scene.h"

namespace knotwave::curves {

Scene surface_scene(const NurbsSurface& surface, const TrimRegion* kept,
                    const PlotOptions& options);  // plot_surface.cpp

namespace {

using base::index_of;

// What a curve looks like: a plane curve in its plane, any other each coordinate over u.
struct Trace {
  int x = -1;  ///< coordinate across; -1 = u
  int y = 0;   ///< coordinate up
};

class CurvePicture {
 public:
  CurvePicture(const NurbsCurve& curve, const PlotOptions& options)
      : curve_(curve), options_(options), spans_(sample_spans(curve, options.width_px)) {
    if (curve.dim() == 2) {
      traces_.push_back({0, 1});
    } else {
      for (int c = 0; c < curve.dim(); ++c) traces_.push_back({-1, c});
    }
    abscissae_ = greville_abscissae(curve);
    scene_.width = options.width_px;
    scene_.height = options.height_px;
    scene_.title = curve.name() + ": " + description_of(curve);
    place_frame();
  }

  Scene drawn() {
    draw_title(scene_, frame_.left, frame_.right, 30, curve_.name(), description_of(curve_));
    const bool plane = traces_[0].x >= 0;
    frame_.draw(scene_, plane ? "x" : "u", plane ? "y" : "value");
    for (std::size_t i = 0; i < traces_.size(); ++i) {
      if (options_.control_polygon) draw_polygon(traces_[i]);
      draw_curve(traces_[i], kCurves[i]);
    }
    if (options_.knots) draw_knots();
    for (std::size_t i = 0; i < traces_.size(); ++i) {
      if (options_.control_polygon) draw_points(traces_[i], kCurves[i]);
    }
    if (traces_.size() > 1) draw_names();
    draw_legend();
    return std::move(scene_);
  }

 private:
  bool shows_weights() const { return options_.weights && curve_.is_rational(); }

  // Points to draw: in a plane those of one period, over u all that lie in it.
  int points_to_draw(Trace trace, int again) const {
    const bool once = trace.x >= 0 && curve_.is_periodic();
    return once ? curve_.point_count() - curve_.degree() + again : curve_.point_count();
  }

  double control(int i, int coordinate) const {
    return coordinate < 0 ? abscissae_[index_of(i)]
                          : curve_.points()[index_of(i * curve_.dim() + coordinate)];
  }

  Point control_at(int i, Trace trace) const {
    return frame_.at(control(i, trace.x), control(i, trace.y));
  }

  Point sample_at(const SpanSamples& span, std::size_t k, Trace trace) const {
    const auto value = [&](int c) {
      return c < 0 ? span.u[k] : span.values[k * index_of(curve_.dim()) + index_of(c)];
    };
    return frame_.at(value(trace.x), value(trace.y));
  }

  void place_frame() {
    frame_.left = 76;
    frame_.right = options_.width_px - 28.0;
    frame_.top = 66;
    frame_.bottom = options_.height_px - 62.0;
    frame_.x = range_of(traces_[0].x);
    frame_.y = range_of(traces_[0].y);
    for (const Trace trace : traces_) {
      const Range more = range_of(trace.y);
      frame_.y.include(more.low);
      frame_.y.include(more.high);
    }
    const double margin = (shows_weights() ? 0.09 : 0.05) * frame_.y.size();
    frame_.y = {frame_.y.low - margin, frame_.y.high + margin};
    frame_.left = std::max(frame_.left, frame_.width_of_numbers() + 22);
    if (traces_[0].x < 0) return;
    frame_.x = {frame_.x.low - 0.05 * frame_.x.size(), frame_.x.high + 0.05 * frame_.x.size()};
    // A curve in a plane that goes back and forth is a shape: the same scale both ways.
    const double scale_x = frame_.x.size() / (frame_.right - frame_.left);
    const double scale_y = frame_.y.size() / (frame_.bottom - frame_.top);
    if (is_non_decreasing(curve_, 0) || scale_x > 8 * scale_y || scale_y > 8 * scale_x) return;
    const auto widen = [](Range& range, double factor) {
      const double more = (factor - 1) * range.size() / 2;
      range = {range.low - more, range.high + more};
    };
    if (scale_x < scale_y) widen(frame_.x, scale_y / scale_x);
    if (scale_y < scale_x) widen(frame_.y, scale_x / scale_y);
  }

  Range range_of(int coordinate) const {
    if (coordinate < 0) return {curve_.u_min(), curve_.u_max()};
    Range range = curves::range_of(spans_, curve_.dim(), coordinate);
    if (options_.control_polygon) {
      const HullRange hull = hull_range(curve_, coordinate);
      range.include(hull.low);
      range.include(hull.high);
    }
    return widened(range);
  }

  void draw_polygon(Trace trace) {
    std::vector<Point> line;
    for (int i = 0; i < points_to_draw(trace, 1); ++i) {
      const Point point = control_at(i, trace);
      if (frame_.holds(point)) line.push_back(point);
    }
    if (line.size() > 1) scene_.line(std::move(line), kPolygon, 1.4, 6);
  }

  void draw_curve(Trace trace, Color color) {
    std::vector<Point> line;
    for (const SpanSamples& span : spans_) {
      const Point start = sample_at(span, 0, trace);
      const auto& jumps = curve_.jumps();
      if (!line.empty() && std::find(jumps.begin(), jumps.end(), span.u0) != jumps.end()) {
        const Point end = line.back();
        scene_.line({end, start}, color, 1.4, 3);
        scene_.line(std::move(line), color, 3);
        line.clear();
      }
      for (std::size_t k = line.empty() ? 0 : 1; k < span.u.size(); ++k) {
        line.push_back(sample_at(span, k, trace));
      }
    }
    scene_.line(std::move(line), color, 3);
  }

  // On the axis of u a tick a time, and on each curve a white dot.
  void draw_knots() {
    for (const KnotMark& mark : knot_marks(curve_)) {
      const bool ends = mark.u == curve_.u_min() || mark.u == curve_.u_max();
      for (std::size_t i = 0; i < traces_.size(); ++i) {
        std::vector<double> value(index_of(curve_.dim()));
        curve_.evaluate(mark.u, mark.u == curve_.u_max() ? Side::left : Side::right, value);
        const Trace trace = traces_[i];
        const double x = trace.x < 0 ? mark.u : value[index_of(trace.x)];
        const Point at = frame_.at(x, value[index_of(trace.y)]);
        const bool is_seam = trace.x >= 0 && mark.u == curve_.u_min() && meets_itself();
        if (!ends || is_seam) scene_.disc(at, 3.2, kWhite, kCurves[i], 1.6);
        if (traces_[0].x >= 0 && !ends && mark.multiplicity > 1) {
          scene_.text({at.x + 7, at.y + 14}, "x" + std::to_string(mark.multiplicity), kInk, 11);
        }
      }
      if (traces_[0].x >= 0) continue;
      const double middle = frame_.at(mark.u, frame_.y.low).x;
      for (int k = 0; k < mark.multiplicity; ++k) {
        const double x = middle + 3.5 * (k - 0.5 * (mark.multiplicity - 1));
        scene_.line({{x, frame_.bottom + 2}, {x, frame_.bottom + 11}}, kInk, 1.6);
      }
    }
  }

  // Where a closed curve in a plane begins is where it ends: a knot as the others.
  bool meets_itself() const {
    std::vector<double> start(index_of(curve_.dim())), end = start;
    curve_.evaluate(curve_.u_min(), Side::right, start);
    curve_.evaluate(curve_.u_max(), Side::left, end);
    return start == end;
  }

  // The area of a point is its weight next to the others'.
  double radius_of(int i) const {
    double least = curve_.weights()[0], most = least;
    for (const double w : curve_.weights()) {
      least = std::min(least, w);
      most = std::max(most, w);
    }
    if (!options_.weights || !(most > least)) return 4.5;
    return 3 + 7 * std::sqrt(curve_.weights()[index_of(i)] / most);
  }

  void draw_points(Trace trace, Color color) {
    const Color fill = traces_.size() > 1 ? color : kPoint;
    for (int i = 0; i < points_to_draw(trace, 0); ++i) {
      const Point point = control_at(i, trace);
      if (!frame_.holds(point)) continue;
      const double radius = radius_of(i);
      scene_.disc(point, radius, {fill.red, fill.green, fill.blue, 0.9}, kWhite, 1.2);
      if (!shows_weights() || points_to_draw(trace, 0) > 24) continue;
      draw_weight(point, radius, "w " + short_text(curve_.weights()[index_of(i)]));
    }
  }

  // Beside its point, on the first of four sides where no other weight is; left out when there is
  // one on each (the size of the point tells it too).
  void draw_weight(Point point, double radius, const std::string& words) {
    constexpr double kSize = 11;
    const double width = text_width(words, kSize) * 1.15;  // fonts differ
    const bool at_end = point.x > frame_.right - 40;
    for (const bool below : {false, true}) {
      for (const bool left : {at_end, !at_end}) {
        const double x = point.x + (left ? -radius - 3 : radius + 3);
        const double y = below ? point.y + radius + 10 : point.y - radius - 1;
        const Box box{left ? x - width : x, y - kSize, left ? x : x + width, y};
        const bool is_free = std::none_of(taken_.begin(), taken_.end(), [&](const Box& other) {
          return box.left < other.right && other.left < box.right && box.top < other.bottom &&
                 other.top < box.bottom;
        });
        if (!is_free || box.right > options_.width_px) continue;
        taken_.push_back(box);
        return scene_.text({x, y}, words, kInk, kSize,
                           left ? Shape::Anchor::end : Shape::Anchor::start);
      }
    }
  }

  // What the marks mean, along the lower edge, in as many words as there is room for.
  void draw_legend() {
    const bool plane = traces_[0].x >= 0;
    std::string point = options_.control_polygon ? "control point" : "";
    std::string knot = options_.knots ? "knot" : "";
    const std::string more_point = shows_weights() ? ", larger with its weight" : "";
    const std::string more_knot = plane ? "" : ", a tick for each time it is repeated";
    const auto fits = [&](const std::string& a, const std::string& b) {
      const double width = text_width(a, 12) + text_width(b, 12) + 38 * 2;
      return frame_.left + width < frame_.right;
    };
    if (!fits(point, "")) return;
    if (!point.empty() && fits(point + more_point, knot)) point += more_point;
    if (!knot.empty() && fits(point, knot + more_knot)) knot += more_knot;
    double x = frame_.left;
    const double y = frame_.bottom + 47;
    const auto say = [&](const std::string& words) {
      scene_.text({x + 12, y}, words, kAxis, 12);
      x += 38 + text_width(words, 12);
    };
    if (!point.empty()) {
      scene_.disc({x + 3, y - 4}, 4, kPoint, kWhite, 1);
      say(point);
    }
    if (knot.empty() || !fits(point, knot)) return;
    if (plane) {
      scene_.disc({x + 3, y - 4}, 3.2, kWhite, kCurves[0], 1.6);
    } else {
      scene_.line({{x + 3, y - 9}, {x + 3, y}}, kInk, 1.6);
    }
    say(knot);
  }

  void draw_names() {
    for (std::size_t i = 0; i < traces_.size(); ++i) {
      const double x = frame_.left + 30 + 70.0 * static_cast<double>(i);
      scene_.line({{x, 54}, {x + 22, 54}}, kCurves[i], 3);
      scene_.text({x + 28, 59}, "x" + std::to_string(i), kInk, 13);
    }
  }

  const NurbsCurve& curve_;
  PlotOptions options_;
  std::vector<SpanSamples> spans_;
  std::vector<Trace> traces_;
  std::vector<double> abscissae_;
  Frame frame_;
  struct Box {
    double left, top, right, bottom;
  };
  std::vector<Box> taken_;  ///< by weights
  Scene scene_;
};

}  // namespace

std::string plot_svg(const NurbsCurve& curve, const PlotOptions& options) {
  return svg_of(CurvePicture(curve, options).drawn());
}

std::string plot_svg(const NurbsSurface& surface, const PlotOptions& options) {
  return svg_of(surface_scene(surface, nullptr, options));
}

std::string plot_svg(const NurbsSurface& surface, const TrimRegion& kept,
                     const PlotOptions& options) {
  return svg_of(surface_scene(surface, &kept, options));
}

std::vector<std::uint8_t> plot_png(const NurbsCurve& curve, const PlotOptions& options) {
  return png_of(CurvePicture(curve, options).drawn());
}

std::vector<std::uint8_t> plot_png(const NurbsSurface& surface, const PlotOptions& options) {
  return png_of(surface_scene(surface, nullptr, options));
}

std::vector<std::uint8_t> plot_png(const NurbsSurface& surface, const TrimRegion& kept,
                                   const PlotOptions& options) {
  return png_of(surface_scene(surface, &kept, options));
}

}  // namespace knotwave::curves
