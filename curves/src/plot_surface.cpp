// SPDX-License-Identifier: MIT
// A surface as a shaded grid seen from above and aside: parallel projection, far tiles first.
#include <algorithm>
#include <cmath>

#include "knotwave/curves/plot.h"

#include "plot_axes.h"
#include "plot_scene.h"

namespace knotwave::curves {

Scene surface_scene(const NurbsSurface& surface, const TrimRegion* kept,
                    const PlotOptions& options);

namespace {

struct Place {
  double x = 0, y = 0, z = 0;
};

constexpr int kAcross = 60;  // tiles along u
constexpr int kDeep = 32;    // along v

class SurfacePicture {
 public:
  SurfacePicture(const NurbsSurface& surface, const TrimRegion* kept, const PlotOptions& options)
      : surface_(surface), kept_(kept), options_(options) {
    scene_.width = options.width_px;
    scene_.height = options.height_px;
    scene_.title = surface.name() + ": " + description();
    // Values over (u, v), or a surface in space.
    in_space_ = surface.dim() >= 3;
    measure();
    fit();
  }

  Scene drawn() {
    draw_title(scene_, 28, options_.width_px - 28.0, 34, surface_.name(), description());
    draw_floor();
    draw_tiles();
    if (kept_ != nullptr) {
      draw_borders();
    } else if (options_.control_polygon) {
      draw_net();
    }
    return std::move(scene_);
  }

 private:
  std::string description() const {
    const int count_u = surface_.count_u() - (surface_.is_periodic_u() ? surface_.degree_u() : 0);
    std::string text = "degree " + std::to_string(surface_.degree_u()) + " x " +
                       std::to_string(surface_.degree_v());
    if (surface_.is_rational()) text += ", rational";
    text += ", " + std::to_string(surface_.count_v()) + " rows of " + std::to_string(count_u) +
            " points";
    if (surface_.is_periodic_u()) text += ", periodic";
    if (surface_.dim() == 2) text += ", left channel";
    if (kept_ != nullptr) text += ", trimmed";
    return text;
  }

  // Raw place of (u, v) or of a control point.
  Place place_of(double u, double v) const {
    double value[kMaxDim];
    surface_.evaluate(u, v, value);
    return in_space_ ? Place{value[0], value[1], value[2]} : Place{u, v, value[0]};
  }

  double along(Range range, int i, int count) const {
    return i == count ? range.high : range.low + range.size() * i / count;
  }

  void measure() {
    const Range u{surface_.u_min(), surface_.u_max()}, v{surface_.v_min(), surface_.v_max()};
    for (int j = 0; j <= kDeep; ++j) {
      for (int i = 0; i <= kAcross; ++i) {
        // The end of a period is its start again, seen from the left.
        double at = along(u, i, kAcross);
        if (surface_.is_periodic_u() && i == kAcross) at = u.low;
        Place place = place_of(at, along(v, j, kDeep));
        if (!in_space_) place.x = along(u, i, kAcross);
        grid_.push_back(place);
      }
    }
    box_[0] = {grid_[0].x, grid_[0].x};
    box_[1] = {grid_[0].y, grid_[0].y};
    box_[2] = {grid_[0].z, grid_[0].z};
    for (const Place& place : grid_) {
      box_[0].include(place.x);
      box_[1].include(place.y);
      box_[2].include(place.z);
    }
    for (Range& range : box_) {
      if (!(range.size() > 1e-9 * std::abs(range.high))) range = {range.low - 1, range.high + 1};
    }
  }

  // To a unit box; then turned by 30 degrees and seen from 28 degrees above.
  Place unit(Place place) const {
    return {(place.x - box_[0].low) / box_[0].size() - 0.5,
            (place.y - box_[1].low) / box_[1].size() - 0.5,
            (place.z - box_[2].low) / box_[2].size() - 0.5};
  }
  static constexpr double kCosTurn = 0.8660254037844387, kSinTurn = 0.5;
  static constexpr double kCosTilt = 0.8829475928589269, kSinTilt = 0.4694715627858908;

  Point project(Place place) const {
    const Place p = unit(place);
    const double x = 1.5 * p.x, y = 1.1 * p.y, z = 0.62 * p.z;
    const double across = x * kCosTurn - y * kSinTurn, back = x * kSinTurn + y * kCosTurn;
    return {middle_.x + scale_ * across, middle_.y - scale_ * (z * kCosTilt + back * kSinTilt)};
  }
  double depth(Place place) const {
    const Place p = unit(place);
    return (1.5 * p.x * kSinTurn + 1.1 * p.y * kCosTurn) * kCosTilt - 0.62 * p.z * kSinTilt;
  }

  // The largest scale at which the box and its names fit.
  void fit() {
    scale_ = 1;
    middle_ = {0, 0};
    Range x{0, 0}, y{0, 0};
    for (int corner = 0; corner < 8; ++corner) {
      const Point p = project(corner_of(corner));
      x.include(p.x);
      y.include(p.y);
    }
    const double width = options_.width_px - 170.0, height = options_.height_px - 140.0;
    scale_ = std::min(width / x.size(), height / y.size());
    middle_ = {options_.width_px / 2.0 - scale_ * (x.low + x.high) / 2,
               60 + height / 2 - scale_ * (y.low + y.high) / 2};
  }

  Place corner_of(int corner) const {
    return {(corner & 1) != 0 ? box_[0].high : box_[0].low,
            (corner & 2) != 0 ? box_[1].high : box_[1].low,
            (corner & 4) != 0 ? box_[2].high : box_[2].low};
  }

  void draw_floor() {
    scene_.area({project(corner_of(0)), project(corner_of(1)), project(corner_of(3)),
                 project(corner_of(2))},
                {247, 248, 250}, kAxis, 1);
    const auto ticks_x = round_ticks(box_[0], 6);
    const auto texts_x = tick_texts(ticks_x);
    for (std::size_t i = 0; i < ticks_x.size(); ++i) {
      const double tick = ticks_x[i];
      scene_.line(
          {project({tick, box_[1].low, box_[2].low}), project({tick, box_[1].high, box_[2].low})},
          kFaint, 1);
      const Point foot = project({tick, box_[1].low, box_[2].low});
      scene_.text({foot.x + 2, foot.y + 18}, texts_x[i], kInk, 12, Shape::Anchor::start);
    }
    const auto ticks_y = round_ticks(box_[1], 5);
    const auto texts_y = tick_texts(ticks_y);
    for (std::size_t i = 0; i < ticks_y.size(); ++i) {
      const double tick = ticks_y[i];
      scene_.line(
          {project({box_[0].low, tick, box_[2].low}), project({box_[0].high, tick, box_[2].low})},
          kFaint, 1);
      const Point foot = project({box_[0].low, tick, box_[2].low});
      scene_.text({foot.x - 8, foot.y + 14}, texts_y[i], kInk, 12, Shape::Anchor::end);
    }
    const Point high = project(corner_of(6)), low = project(corner_of(2));
    scene_.line({low, high}, kAxis, 1);
    const auto ticks_z = round_ticks(box_[2], 5);
    const auto texts_z = tick_texts(ticks_z);
    for (std::size_t i = 0; i < ticks_z.size(); ++i) {
      const double tick = ticks_z[i];
      const Point foot = project({box_[0].low, box_[1].high, tick});
      scene_.line({{foot.x - 4, foot.y}, foot}, kAxis, 1);
      // The corner below is where v ends: its number has the place.
      if (tick < box_[2].low + 0.05 * box_[2].size()) continue;
      scene_.text({foot.x - 8, foot.y + 4}, texts_z[i], kInk, 12, Shape::Anchor::end);
    }
    const Point u = project({0.5 * (box_[0].low + box_[0].high), box_[1].low, box_[2].low});
    const Point v = project({box_[0].low, 0.5 * (box_[1].low + box_[1].high), box_[2].low});
    scene_.text({u.x + 10, u.y + 42}, in_space_ ? "x" : "u", kInk, 15, Shape::Anchor::middle, true);
    scene_.text({v.x - 34, v.y + 38}, in_space_ ? "y" : "v", kInk, 15, Shape::Anchor::middle, true);
    scene_.text({high.x, high.y - 14}, in_space_ ? "z" : "value", kInk, 15, Shape::Anchor::middle,
                true);
  }

  // Light from the upper left; low is deep blue, high is warm.
  Color shade(const Place& a, const Place& b, const Place& c, double height) const {
    const Place p = unit(a), q = unit(b), r = unit(c);
    const double ux = q.x - p.x, uy = q.y - p.y, uz = 0.6 * (q.z - p.z);
    const double vx = r.x - p.x, vy = r.y - p.y, vz = 0.6 * (r.z - p.z);
    double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
    if (length > 0) {
      nx /= length;
      ny /= length;
      nz /= length;
    }
    const double facing = std::abs(-0.55 * nx - 0.35 * ny + 0.76 * nz);
    const double light = 0.62 + 0.38 * facing;
    struct Stop {
      double red, green, blue;
    };
    constexpr Stop kStops[] = {
        {24, 60, 148}, {20, 130, 190}, {90, 190, 160}, {250, 206, 90}, {240, 120, 50}};
    const double at = std::clamp(height, 0.0, 1.0) * 4;
    const int i = std::min(3, static_cast<int>(at));
    const double t = at - i;
    const auto mix = [&](double from, double to) {
      return static_cast<std::uint8_t>(light * (from + t * (to - from)));
    };
    return {mix(kStops[i].red, kStops[i + 1].red), mix(kStops[i].green, kStops[i + 1].green),
            mix(kStops[i].blue, kStops[i + 1].blue), 1};
  }

  const Place& corner(int i, int j) const {
    return grid_[static_cast<std::size_t>(j) * (kAcross + 1) + static_cast<std::size_t>(i)];
  }

  void draw_tiles() {
    struct Tile {
      double depth;
      int i, j;
    };
    std::vector<Tile> tiles;
    for (int j = 0; j < kDeep; ++j) {
      for (int i = 0; i < kAcross; ++i) {
        tiles.push_back({depth(corner(i, j)) + depth(corner(i + 1, j + 1)), i, j});
      }
    }
    std::stable_sort(tiles.begin(), tiles.end(),
                     [](const Tile& a, const Tile& b) { return a.depth > b.depth; });
    for (const Tile& tile : tiles) {
      if (kept_ != nullptr && !is_whole(tile.i, tile.j)) {
        draw_rest_of_tile(tile.i, tile.j);
        continue;
      }
      const Place &a = corner(tile.i, tile.j), &b = corner(tile.i + 1, tile.j),
                  &c = corner(tile.i + 1, tile.j + 1), &d = corner(tile.i, tile.j + 1);
      const double height = 0.5 + 0.25 * (unit(a).z + unit(b).z + unit(c).z + unit(d).z);
      const Color fill = shade(a, b, d, height);
      const std::vector<Point> corners = {project(a), project(b), project(c), project(d)};
      // The outline in the tile's colour closes the seams between tiles.
      scene_.area(corners, fill, fill, 0.8);
      const Color line{255, 255, 255, 0.35};
      if (tile.j % 4 == 0) scene_.line({corners[0], corners[1]}, line, 1);
      if (tile.i % 6 == 0) scene_.line({corners[0], corners[3]}, line, 1);
      if (tile.j == kDeep - 1) scene_.line({corners[3], corners[2]}, line, 1);
      if (tile.i == kAcross - 1) scene_.line({corners[1], corners[2]}, line, 1);
    }
  }

  Place place_at(double i, double j) const {
    const Range u{surface_.u_min(), surface_.u_max()}, v{surface_.v_min(), surface_.v_max()};
    return {u.low + u.size() * i / kAcross, v.low + v.size() * j / kDeep, 0};
  }
  bool is_kept(double i, double j) const {
    const Place place = place_at(i, j);
    return kept_->contains(place.x, place.y);
  }
  bool is_whole(int i, int j) const {
    return is_kept(i, j) && is_kept(i + 1, j) && is_kept(i, j + 1) && is_kept(i + 1, j + 1) &&
           is_kept(i + 0.5, j + 0.5);
  }

  // Of a tile that is cut, the small ones whose middle is kept.
  void draw_rest_of_tile(int i, int j) {
    constexpr int kParts = 6;
    const Place &a = corner(i, j), &b = corner(i + 1, j), &d = corner(i, j + 1);
    const auto spot = [&](int k, int l) {
      const Place at =
          place_at(i + static_cast<double>(k) / kParts, j + static_cast<double>(l) / kParts);
      return place_of(at.x, at.y);
    };
    for (int l = 0; l < kParts; ++l) {
      for (int k = 0; k < kParts; ++k) {
        if (!is_kept(i + (k + 0.5) / kParts, j + (l + 0.5) / kParts)) continue;
        const Place first = spot(k, l);
        const Color fill = shade(a, b, d, 0.5 + unit(first).z);
        scene_.area({project(first), project(spot(k + 1, l)), project(spot(k + 1, l + 1)),
                     project(spot(k, l + 1))},
                    fill, fill, 0.8);
      }
    }
  }

  // The loops, as far as they run over the surface.
  void draw_borders() {
    for (const TrimLoop& loop : kept_->loops()) {
      for (const NurbsCurve& curve : loop) {
        std::vector<Point> line;
        const int steps = 48 * (curve.point_count() - curve.degree());
        for (int i = 0; i <= steps; ++i) {
          double at[2];
          curve.evaluate(along({curve.u_min(), curve.u_max()}, i, steps), at);
          const bool on_surface = at[0] >= surface_.u_min() && at[0] <= surface_.u_max() &&
                                  at[1] >= surface_.v_min() && at[1] <= surface_.v_max();
          if (on_surface) line.push_back(project(place_of(at[0], at[1])));
          if (on_surface && i < steps) continue;
          if (line.size() > 1) scene_.line(line, kInk, 2);
          line.clear();
        }
      }
    }
  }

  // The front row and the back row are curves of the file: drawn strong.
  void draw_net() {
    for (const int j : {kDeep, 0}) {
      std::vector<Point> row;
      for (int i = 0; i <= kAcross; ++i) {
        row.push_back(project(corner(i, j)));
      }
      if (j == 0) scene_.line(std::move(row), kInk, 2);
    }
  }

  const NurbsSurface& surface_;
  const TrimRegion* kept_;
  PlotOptions options_;
  bool in_space_ = false;
  std::vector<Place> grid_;
  Range box_[3];
  double scale_ = 1;
  Point middle_;
  Scene scene_;
};

}  // namespace

Scene surface_scene(const NurbsSurface& surface, const TrimRegion* kept,
                    const PlotOptions& options) {
  return SurfacePicture(surface, kept, options).drawn();
}

}  // namespace knotwave::curves
