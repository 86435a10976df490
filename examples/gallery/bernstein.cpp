// SPDX-License-Identifier: MIT
// How much each of four points counts along a cubic: four levels that add up to 1 everywhere. One
// map with four coordinates, whose points are (1, 0, 0, 0) to (0, 0, 0, 1), is all four of them. As
// sound they are the levels of four tones: a cross-fade of four.
#include <array>

#include "gallery.h"
#include "picture.h"
#include "sound.h"

namespace gallery {

using namespace knotwave;
using curves::Target;

namespace {

constexpr std::array<double, 16> kUnitPoints = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
constexpr std::array kColors = {kHues[0], kHues[2], kHues[4], kHues[5]};
constexpr std::size_t kSteps = 240;

using Levels = std::array<std::vector<double>, 4>;

void draw_levels(Picture& picture, const Frame& frame, const Levels& levels) {
  frame.draw(picture);
  for (std::size_t k = 0; k < 4; ++k) {
    std::vector<Point> line;
    for (std::size_t i = 0; i <= kSteps; ++i) {
      line.push_back(frame.at(double(i) / kSteps, levels[k][i]));
    }
    std::vector<Point> below = line;
    below.push_back(frame.at(1, 0));
    below.push_back(frame.at(0, 0));
    picture.area(below, kColors[k], 0.10);
    picture.line(line, {.color = kColors[k], .width = 3});
  }
  constexpr std::array<const char*, 4> kNames = {"(1-u)³", "3u(1-u)²", "3u²(1-u)", "u³"};
  constexpr std::array<Point, 4> kPlaces = {
      {{0.07, 0.93}, {0.333, 0.48}, {0.667, 0.48}, {0.93, 0.93}}};
  for (std::size_t k = 0; k < 4; ++k) {
    const Point at = frame.at(kPlaces[k].x, kPlaces[k].y);
    const char* anchor = k == 0 ? "start" : k == 3 ? "end" : "middle";
    picture.text(at, kNames[k], {.size = 15, .color = kColors[k], .anchor = anchor, .bold = true});
  }
}

void draw_stack(Picture& picture, const Frame& frame, const Levels& levels) {
  std::vector<double> below(kSteps + 1);
  for (std::size_t k = 0; k < 4; ++k) {
    std::vector<Point> band;
    for (std::size_t i = 0; i <= kSteps; ++i)
      band.push_back(frame.at(double(i) / kSteps, below[i]));
    for (std::size_t i = kSteps + 1; i-- > 0;) {
      below[i] += levels[k][i];
      band.push_back(frame.at(double(i) / kSteps, below[i]));
    }
    picture.area(band, kColors[k], 0.85, {.color = "#fdfdfb", .width = 1.5});
  }
}

void draw_scale(Picture& picture, const Frame& frame, const std::string& title) {
  picture.text({(frame.left + frame.right) / 2, frame.top - 14}, title,
               {.size = 14, .color = "#5b6570", .anchor = "middle"});
  for (const double value : {0.0, 1.0}) {
    const Point foot = frame.at(value, 0), side = frame.at(0, value);
    picture.text({foot.x, foot.y + 20}, value == 0 ? "u = 0" : "1", {.anchor = "middle"});
    picture.text({side.x - 8, side.y + 5}, value == 0 ? "0" : "1", {.anchor = "end"});
  }
}

}  // namespace

Result<void> bernstein(const std::string& folder) {
  auto map = curves::bezier_map({Target::modulation, 1, 4, false}, 0, 1, 4, 4, kUnitPoints);
  if (!map) return map.error();
  curves::MapSet maps;
  const auto key = maps.define(std::move(*map));
  if (!key) return key.error();
  maps.enable(*key);

  Levels levels;
  for (int k = 0; k < 4; ++k) {
    levels[std::size_t(k)] = over_grid(maps, Target::modulation, k, kSteps);
  }
  Picture picture(1080, 520, "Bernstein polynomials of degree 3",
                  "What each of four points weighs along a cubic Bézier curve");
  const Frame left{60, Picture::kTop + 40, 520, 470}, right{590, Picture::kTop + 40, 1050, 470};
  draw_scale(picture, left, "one by one");
  draw_levels(picture, left, levels);
  draw_scale(picture, right, "one on top of the other: 1 at every u");
  draw_stack(picture, right, levels);
  if (auto ok = picture.save(folder + "/bernstein.svg"); !ok) return ok;

  constexpr std::size_t kFrames = 8 * kSecond;
  constexpr std::array kNotes = {48.0, 55.0, 64.0, 71.0};  // C3 G3 E4 B4
  Stereo sound(kFrames);
  for (int k = 0; k < 4; ++k) {
    auto level = over_grid(maps, Target::modulation, k, kFrames - 1);
    for (double& x : level) x *= 0.5;
    const std::vector<double> note(kFrames, kNotes[std::size_t(k)]);
    sound.add_tone(note, level, 0.2 + 0.2 * k);
  }
  return sound.save(folder + "/bernstein.wav");
}

}  // namespace gallery
