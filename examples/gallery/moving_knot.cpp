// SPDX-License-Identifier: MIT
// The six basis functions of a cubic B-spline with two inner knots, while one of the two moves:
// where both meet, what is between them loses a derivative. As sound each function is the level of
// a note, and there is one pass for each picture: the knot moves the notes.
#include <algorithm>
#include <array>
#include <cstddef>

#include "gallery.h"
#include "picture.h"
#include "sound.h"

namespace gallery {

using namespace knotwave;
using curves::Target;

namespace {

constexpr double kFixed = 0.6;
constexpr std::array kMoving = {0.05, 0.2, 0.4, 0.6, 0.75, 0.95};
constexpr std::size_t kFunctions = 6;
constexpr std::size_t kSteps = 300;
constexpr std::array kColors = {kHues[0], kHues[1], kHues[2], kHues[4], kHues[5], kHues[6]};

/// Points first..first+2 are (1, 0, 0), (0, 1, 0), (0, 0, 1), the others 0: the coordinates are
/// three basis functions.
Result<curves::NurbsCurve> basis(std::size_t first, double knot) {
  curves::CurveSpec spec;
  spec.name = "basis";
  spec.degree = 3;
  spec.dim = 3;
  spec.points.assign(kFunctions * 3, 0.0);
  for (std::size_t k = 0; k < 3; ++k) spec.points[(first + k) * 3 + k] = 1;
  const double low = knot < kFixed ? knot : kFixed, high = knot < kFixed ? kFixed : knot;
  spec.knots = {0, 0, 0, 0, low, high, 1, 1, 1, 1};
  return curves::NurbsCurve::create(std::move(spec));
}

using Functions = std::array<std::vector<double>, kFunctions>;

Result<Functions> functions(double knot, std::size_t steps) {
  curves::MapSet maps;
  if (auto ok = bind(maps, Target::free_1, basis(0, knot)); !ok) return ok.error();
  if (auto ok = bind(maps, Target::free_2, basis(3, knot)); !ok) return ok.error();
  Functions all;
  for (std::size_t k = 0; k < kFunctions; ++k) {
    all[k] = over_grid(maps, k < 3 ? Target::free_1 : Target::free_2, int(k % 3), steps);
  }
  return all;
}

void draw_knot(Picture& picture, const Frame& frame, double knot, const char* color) {
  const Point foot = frame.at(knot, 0);
  picture.line({foot.x, frame.top}, foot,
               {.color = color, .width = 1.4, .opacity = 0.7, .dash = 4});
  const std::array mark = {Point{foot.x, foot.y + 3}, Point{foot.x - 7, foot.y + 15},
                           Point{foot.x + 7, foot.y + 15}};
  picture.area(mark, color);
}

void draw_panel(Picture& picture, const Frame& frame, const Functions& all, double knot) {
  frame.draw(picture);
  draw_knot(picture, frame, kFixed, kSoft);
  draw_knot(picture, frame, knot, kOrange);
  for (std::size_t k = 0; k < kFunctions; ++k) {
    // Only where it is not 0: a function lives on four spans.
    const auto is_there = [](double x) { return x > 0; };
    const auto first = std::find_if(all[k].begin(), all[k].end(), is_there) - all[k].begin();
    const auto last =
        std::find_if(all[k].rbegin(), all[k].rend(), is_there).base() - all[k].begin();
    std::vector<Point> line;
    for (auto i = std::max(first - 1, std::ptrdiff_t{0});
         i < std::min(last + 1, std::ptrdiff_t{kSteps + 1}); ++i) {
      line.push_back(frame.at(double(i) / kSteps, all[k][std::size_t(i)]));
    }
    std::vector<Point> below = line;
    below.push_back({line.back().x, frame.bottom});
    below.push_back({line.front().x, frame.bottom});
    picture.area(below, kColors[k], 0.09);
    picture.line(line, {.color = kColors[k], .width = 2.6});
  }
  std::string text = std::to_string(knot);
  text.erase(text.find_last_not_of('0') + 1);
  const std::string words = knot == kFixed ? "both knots at 0.6" : "knot at " + text;
  picture.text({(frame.left + frame.right) / 2, frame.top - 12}, words,
               {.size = 14, .anchor = "middle", .bold = knot == kFixed});
}

}  // namespace

Result<void> moving_knot(const std::string& folder) {
  Picture picture(1080, 620, "B-spline basis functions while one knot moves",
                  "Degree 3, six functions that add up to 1. The orange knot moves, the grey one "
                  "stays at 0.6");
  constexpr std::size_t kPass = 2 * kSecond;
  constexpr std::array kNotes = {48.0, 55.0, 60.0, 64.0, 67.0, 74.0};  // C3 G3 C4 E4 G4 D5
  std::array<std::vector<double>, kFunctions> levels;
  for (std::size_t i = 0; i < kMoving.size(); ++i) {
    const std::size_t column = i % 3, row = i / 3;
    const double left = 40 + 345 * double(column), top = Picture::kTop + 42 + 265 * double(row);
    const auto all = functions(kMoving[i], kSteps);
    if (!all) return all.error();
    draw_panel(picture, Frame{left, top, left + 310, top + 185}, *all, kMoving[i]);
    const auto heard = functions(kMoving[i], kPass - 1);
    if (!heard) return heard.error();
    for (std::size_t k = 0; k < kFunctions; ++k) {
      for (std::size_t j = 0; j < kPass; ++j) {
        levels[k].push_back(0.5 * fade(j, kPass) * (*heard)[k][j]);
      }
    }
  }
  if (auto ok = picture.save(folder + "/moving_knot.svg"); !ok) return ok;

  Stereo sound(kPass * kMoving.size());
  for (std::size_t k = 0; k < kFunctions; ++k) {
    const std::vector<double> note(levels[k].size(), kNotes[k]);
    sound.add_tone(note, levels[k], 0.1 + 0.16 * double(k));
  }
  return sound.save(folder + "/moving_knot.wav");
}

}  // namespace gallery
