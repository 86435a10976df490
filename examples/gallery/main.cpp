// SPDX-License-Identifier: MIT
// You learn: where Bézier curves, B-splines and surfaces come from, by eye and by ear; and how maps
//            evaluate many curves at one coordinate (knotwave/curves/map.h).
// Run:       build/release/bin/gallery out/gallery
// It writes: five pictures (SVG) and beside each a sound (WAV) made of the same numbers.
#include <cstdio>
#include <filesystem>

#include "gallery.h"

namespace gallery {

using namespace knotwave;
using curves::MapSet;

Result<void> bind(MapSet& maps, curves::Target target, const Result<curves::NurbsCurve>& curve) {
  if (!curve) return curve.error();
  const auto key = maps.define(curves::Map1{target, 0, 1, *curve});
  if (!key) return key.error();
  maps.enable(*key);
  return {};
}

std::vector<double> over_grid(const MapSet& maps, curves::Target target, int coordinate,
                              std::size_t n) {
  std::vector<double> out(n + 1);
  const MapSet::Channel channel{target, coordinate, out};
  maps.evaluate_grid({0, 1, static_cast<std::int64_t>(n)}, 0, {&channel, 1});
  return out;
}

}  // namespace gallery

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
    return 2;
  }
  const std::string folder = argv[1];
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);  // a fault shows when files are written
  for (const auto& made :
       {gallery::string_art(folder, 3), gallery::string_art(folder, 4), gallery::bernstein(folder),
        gallery::surface(folder), gallery::moving_knot(folder)}) {
    if (made) continue;
    std::fprintf(stderr, "%s\n", made.error().to_string().c_str());
    return 1;
  }
  std::printf(
      "%s: 5 pictures (.svg) and what they sound like (.wav)\n"
      "string_art_quadratic  left and right the pitches of the two ends of a string, in the "
      "middle\n"
      "                      that of the curve: it leaves the left one and arrives at the right "
      "one\n"
      "string_art_cubic      the same; the ends are quadratic curves themselves\n"
      "bernstein             four notes from low to high, each as loud as its point weighs\n"
      "surface               u read as one cycle of a wave at 110 Hz, while v goes from 0 to 1\n"
      "moving_knot           six notes, one a function, once for each place of the knot\n",
      folder.c_str());
  return 0;
}
