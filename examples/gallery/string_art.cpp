// SPDX-License-Identifier: MIT
// Two points move along the lines of the control polygon, a string is tied between them, and at the
// same share of the string lies the curve: a cross-fade of cross-fades. The pitch of the two points
// is heard left and right, that of the curve in the middle: it leaves the one and arrives at the
// other.
#include "knotwave/curves/shapes.h"

#include "gallery.h"
#include "picture.h"
#include "sound.h"

namespace gallery {

using namespace knotwave;
using curves::Target;

namespace {

constexpr std::size_t kStrings = 44;
constexpr std::size_t kShown = 18;  // the string that is drawn thick

/// The curve as position, and what strings are tied to: the curves of all points but the last, and
/// of all but the first.
Result<curves::MapSet> construction(std::span<const double> points) {
  curves::MapSet maps;
  if (auto ok = bind(maps, Target::position, curves::bezier(points, 2)); !ok) return ok.error();
  const auto start = points.first(points.size() - 2), end = points.subspan(2);
  if (auto ok = bind(maps, Target::free_1, curves::bezier(start, 2)); !ok) return ok.error();
  if (auto ok = bind(maps, Target::free_2, curves::bezier(end, 2)); !ok) return ok.error();
  return maps;
}

std::vector<Point> track(const curves::MapSet& maps, Target target, const Frame& frame,
                         std::size_t n) {
  const auto x = over_grid(maps, target, 0, n), y = over_grid(maps, target, 1, n);
  std::vector<Point> points;
  for (std::size_t i = 0; i <= n; ++i) points.push_back(frame.at(x[i], y[i]));
  return points;
}

Picture drawn(const curves::MapSet& maps, std::span<const double> numbers) {
  const Frame frame{70, Picture::kTop + 36, 890, 540};
  const bool cubic = numbers.size() == 8;
  Picture picture(960, 600, cubic ? "A cubic Bézier curve" : "A quadratic Bézier curve",
                  cubic ? "Three cross-fades, two between them, one between those"
                        : "Two cross-fades, and one between them");
  std::vector<Point> polygon;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    polygon.push_back(frame.at(numbers[i], numbers[i + 1]));
  }
  const auto from = track(maps, Target::free_1, frame, kStrings);
  const auto to = track(maps, Target::free_2, frame, kStrings);
  const auto curve = track(maps, Target::position, frame, 400);
  picture.line(polygon, {.color = kSoft, .width = 1.6, .dash = 7});
  for (std::size_t i = 0; i <= kStrings; ++i) {
    const double t = double(i) / kStrings;
    picture.line(from[i], to[i], {.color = hue(t), .width = 1.3, .opacity = 0.75});
  }
  picture.line(curve, {.color = "#fdfdfb", .width = 8, .opacity = 0.85});
  picture.line(curve, {.width = 4});

  // One string with all that leads to it.
  constexpr double kShare = double(kShown) / kStrings;
  const std::string color = hue(kShare);
  std::vector<Point> level = polygon;
  while (level.size() > 1) {
    std::vector<Point> next;
    for (std::size_t i = 0; i + 1 < level.size(); ++i) {
      next.push_back(mix(level[i], level[i + 1], kShare));
    }
    if (next.size() > 1) picture.line(next, {.color = color, .width = 2.6});
    for (const Point& point : next) picture.dot(point, next.size() == 1 ? 8 : 5.5, color);
    level = next;
  }
  picture.text({level[0].x + 4, level[0].y + 32}, "u = 0.41",
               {.size = 15, .color = color, .bold = true});
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const bool high = numbers[2 * i + 1] > 0.5;
    picture.dot(polygon[i], 7, kOrange);
    picture.text({polygon[i].x, polygon[i].y + (high ? -14 : 26)}, "P" + std::to_string(i),
                 {.size = 15, .anchor = "middle", .bold = true});
  }
  return picture;
}

/// The height of a target as a note, two octaves from A2.
std::vector<double> notes(const curves::MapSet& maps, Target target, std::size_t frames) {
  auto heights = over_grid(maps, target, 1, frames - 1);
  for (double& height : heights) height = 45 + 24 * height;
  return heights;
}

}  // namespace

Result<void> string_art(const std::string& folder, int points) {
  const std::vector<double> numbers =
      points == 3 ? std::vector<double>{0.0, 0.0, 0.36, 1.0, 1.0, 0.12}
                  : std::vector<double>{0.0, 0.05, 0.2, 1.0, 0.72, 0.95, 1.0, 0.0};
  const auto maps = construction(numbers);
  if (!maps) return maps.error();
  const std::string name = folder + (points == 3 ? "/string_art_quadratic" : "/string_art_cubic");
  if (auto ok = drawn(*maps, numbers).save(name + ".svg"); !ok) return ok;

  constexpr std::size_t kFrames = 6 * kSecond;
  Stereo sound(kFrames);
  const std::vector<double> quiet(kFrames, 0.16), loud(kFrames, 0.34);
  sound.add_tone(notes(*maps, Target::free_1, kFrames), quiet, 0.1);
  sound.add_tone(notes(*maps, Target::free_2, kFrames), quiet, 0.9);
  sound.add_tone(notes(*maps, Target::position, kFrames), loud, 0.5);
  return sound.save(name + ".wav");
}

}  // namespace gallery
