// SPDX-License-Identifier: MIT
// A bi-cubic Bézier surface from 16 points: four cubic curves side by side, and across them, at
// every u, one more. As sound each row is one cycle of a wave, and v goes from front to back in
// eight seconds.
#include <algorithm>
#include <array>
#include <cmath>

#include "knotwave/dsp/oscillator.h"

#include "gallery.h"
#include "picture.h"
#include "sound.h"

namespace gallery {

using namespace knotwave;
using curves::Target;

namespace {

/// Heights, one row a v. Rows end where they begin: they are cycles.
constexpr std::array<double, 16> kHeights = {0.0, 1.5,  -1.3, 0.0,  //
                                             0.0, 0.6,  1.5,  0.0,  //
                                             0.0, -1.2, 0.7,  0.0,  //
                                             0.0, 1.5,  1.2,  0.0};
constexpr int kAcross = 64, kDeep = 48;

/// Seen from the front, the left and above. u runs to the right, v away.
Point place(double u, double v, double height) {
  const double x = u - 0.5, y = v - 0.5;
  return {480 + 560 * x + 250 * y, 405 + 84 * x - 290 * y - 100 * height};
}

/// Low is blue, high is orange; facing the light from the left is bright.
std::string shade(double height, double rise_u) {
  const double light = std::clamp(0.9 + 0.05 * rise_u, 0.72, 1.0);
  constexpr std::array<std::array<double, 3>, 5> kStops = {
      {{38, 64, 160}, {38, 140, 196}, {120, 200, 170}, {250, 206, 96}, {242, 120, 58}}};
  const double at = std::clamp((height + 0.8) / 1.7, 0.0, 1.0) * 4;
  const auto k = static_cast<std::size_t>(std::min(at, 3.0));
  std::string text = "rgb(";
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = kStops[k][c] + (at - double(k)) * (kStops[k + 1][c] - kStops[k][c]);
    text += std::to_string(std::lround(light * value)) + (c < 2 ? "," : ")");
  }
  return text;
}

void draw_surface(Picture& picture, std::span<const double> heights) {
  const auto height = [&](int i, int j) {
    return heights[std::size_t(j) * (kAcross + 1) + std::size_t(i)];
  };
  const auto corner = [&](int i, int j) {
    return place(double(i) / kAcross, double(j) / kDeep, height(i, j));
  };
  for (int j = kDeep; j-- > 0;) {  // from back to front
    for (int i = 0; i < kAcross; ++i) {
      const std::array tile = {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                               corner(i, j + 1)};
      const std::string color = shade((height(i, j) + height(i + 1, j + 1)) / 2,
                                      kAcross * (height(i + 1, j) - height(i, j)));
      picture.area(tile, color, 0.94, {.color = color, .width = 0.6});
      const Stroke thin{.color = "#ffffff", .width = 1, .opacity = 0.5};
      if (j % 6 == 0) picture.line(tile[0], tile[1], thin);
      if (i % 6 == 0) picture.line(tile[0], tile[3], thin);
    }
  }
  for (const int j : {kDeep, 0}) {  // the first and the last row are curves of the surface
    std::vector<Point> line;
    for (int i = 0; i <= kAcross; ++i) line.push_back(corner(i, j));
    picture.line(line, {.color = kInk, .width = 2.4, .opacity = j == 0 ? 1.0 : 0.55});
  }
}

Point net_point(std::size_t i, std::size_t j) {
  return place(double(i) / 3, double(j) / 3, kHeights[j * 4 + i]);
}

void draw_net(Picture& picture, double opacity) {
  const Stroke stroke{.color = "#5b6570", .width = 1.4, .opacity = opacity, .dash = 5};
  for (std::size_t k = 0; k < 4; ++k) {
    std::vector<Point> row, column;
    for (std::size_t i = 0; i < 4; ++i) {
      row.push_back(net_point(i, k));
      column.push_back(net_point(k, i));
    }
    picture.line(row, stroke);
    picture.line(column, stroke);
  }
}

/// One voice at A2 while v goes from 0 to 1: alias-free, from the same 16 numbers.
Result<void> play(const curves::NurbsSurface& surface, const std::string& path) {
  const auto tables = dsp::WaveTables::create(surface);
  if (!tables) return tables.error();
  constexpr std::size_t kFrames = 8 * kSecond;
  Stereo sound(kFrames);
  const std::vector<base::Phase> steps(kFrames, base::phase_increment(110, kRateHz));
  std::vector<float> v(kFrames);
  for (std::size_t i = 0; i < kFrames; ++i) v[i] = static_cast<float>(i) / float(kFrames - 1);
  dsp::TableOscillator oscillator;
  oscillator.start(base::Phase{}, 0);
  oscillator.render(*tables, steps, v, {}, sound.left, sound.right);
  for (float& x : sound.left) x *= 0.3f;
  sound.right = sound.left;
  return sound.save(path);
}

}  // namespace

Result<void> surface(const std::string& folder) {
  auto map =
      curves::bezier_map({Target::wave_position, 2, 1, false}, 0, 1, 1, 4, 0, 1, 4, 4, kHeights);
  if (!map) return map.error();
  curves::MapSet maps;
  const curves::NurbsSurface as_given = map->surface;
  const auto key = maps.define(std::move(*map));
  if (!key) return key.error();
  maps.enable(*key);

  std::vector<double> heights(std::size_t{kAcross + 1} * (kDeep + 1));
  const curves::MapSet::Channel channel{Target::wave_position, 0, heights};
  maps.evaluate_mesh({0, 1, kAcross}, 0, kAcross + 1, {0, 1, kDeep}, 0, {&channel, 1});
  Picture picture(1000, 720, "A bi-cubic Bézier surface",
                  "16 points: four curves side by side, and one across them at every u");
  draw_net(picture, 1);
  draw_surface(picture, heights);
  draw_net(picture, 0.4);  // what lies in front shines through
  for (std::size_t k = 0; k < 16; ++k) picture.dot(net_point(k % 4, k / 4), 6, kOrange);
  const Point u = place(0.5, -0.08, 0), v = place(1.08, 0.5, 0);
  picture.text({u.x - 90, u.y + 60}, "u: phase", {.size = 15, .anchor = "middle", .bold = true});
  picture.text({v.x + 8, v.y}, "v: time", {.size = 15, .bold = true});
  if (auto ok = picture.save(folder + "/surface.svg"); !ok) return ok;
  return play(as_given, folder + "/surface.wav");
}

}  // namespace gallery
