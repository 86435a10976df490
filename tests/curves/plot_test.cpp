// SPDX-License-Identifier: MIT
#include "knotwave/curves/plot.h"

#include <cstdint>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "random_curve.h"
#include "support/program.h"
#include "support/seed.h"

namespace knotwave::test {
namespace {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::NurbsSurface;
using testing::HasSubstr;

NurbsCurve decay() {
  CurveSpec spec;
  spec.name = "decay <60 & more>";
  spec.degree = 2;
  spec.points = {1, 0.25, 0, 0.5};
  spec.weights = {1, 2, 1, 4};
  return *NurbsCurve::create(spec);
}

NurbsSurface hill() {
  curves::SurfaceSpec spec;
  spec.name = "hill";
  spec.degree_u = spec.degree_v = 2;
  spec.count_u = spec.count_v = 3;
  spec.points = {0, 0, 0, 0, 4, 0, 0, 0, 0};
  return *NurbsSurface::create(spec);
}

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Plot, SvgHoldsCurvePolygonPointsWeightsAndKnots) {
  const std::string svg = plot_svg(decay());
  EXPECT_THAT(svg, HasSubstr("decay &lt;60 &amp; more&gt;"));
  EXPECT_THAT(svg, HasSubstr("degree 2, rational, 4 points"));
  EXPECT_THAT(svg, HasSubstr("stroke-dasharray"));  // the control polygon
  EXPECT_EQ(count_of(svg, ">w "), 4);
  EXPECT_EQ(count_of(svg, "stroke=\"#0a5cd6\" stroke-width=\"3\""), 1);  // the curve
  EXPECT_EQ(count_of(svg, "fill=\"#f47b20\" fill-opacity=\"0.9\""), 4);  // its points
  EXPECT_EQ(count_of(svg, "nan") + count_of(svg, "inf"), 0);
  curves::PlotOptions plain;
  plain.control_polygon = plain.knots = plain.weights = false;
  const std::string bare = plot_svg(decay(), plain);
  EXPECT_EQ(count_of(bare, "stroke-dasharray") + count_of(bare, ">w ") + count_of(bare, "circle"),
            0);
}

// The whole file by another reader: Python's zlib checks the stream, both checksums and the size.
TEST(Plot, PngIsReadByAnotherReader) {
  const support::ScratchFolder folder;
  const std::string path = folder.file("plot.png");
  curves::PlotOptions options;
  options.width_px = 333;
  options.height_px = 222;
  const auto save = [&path](const std::vector<std::uint8_t>& png) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(png.data()), static_cast<long>(png.size()));
  };
  const char* reader =
      "import struct, sys, zlib\n"
      "d = open(sys.argv[1], 'rb').read()\n"
      "assert d[:8] == b'\\x89PNG\\r\\n\\x1a\\n'\n"
      "i = 8; types = []\n"
      "while i < len(d):\n"
      "    n, t = struct.unpack('>I4s', d[i:i+8]); c = d[i+8:i+8+n]\n"
      "    assert struct.unpack('>I', d[i+8+n:i+12+n])[0] == zlib.crc32(t + c)\n"
      "    types.append(t); i += 12 + n\n"
      "    if t == b'IHDR': w, h = struct.unpack('>II', c[:8])\n"
      "    if t == b'IDAT': raw = zlib.decompress(c)\n"
      "assert types == [b'IHDR', b'IDAT', b'IEND'] and len(raw) == h * (3 * w + 1)\n"
      "row = bytes(3 * w); colours = set()\n"
      "for y in range(h):\n"
      "    line = raw[y * (3 * w + 1):(y + 1) * (3 * w + 1)]\n"
      "    assert line[0] == 2\n"
      "    row = bytes((a + b) & 255 for a, b in zip(row, line[1:]))\n"
      "    colours |= {row[i:i+3] for i in range(0, len(row), 3)}\n"
      "print(w, h, b'\\x0a\\x5c\\xd6' in colours, b'\\xff\\xff\\xff' in colours)\n";
  save(plot_png(decay(), options));
  auto run = support::run_program({"/usr/bin/python3", "-c", reader, path});
  EXPECT_EQ(run.out, "333 222 True True\n") << run.err;
  save(plot_png(hill(), options));
  run = support::run_program({"/usr/bin/python3", "-c", reader, path});
  EXPECT_EQ(run.out, "333 222 False True\n") << run.err;
}

TEST(Plot, TextHasTheSizeAskedForAndTheEndsOfTheAxes) {
  const std::string text = plot_text(decay(), 60, 10);
  EXPECT_EQ(count_of(text, "\n"), 11);
  EXPECT_THAT(text, HasSubstr("        1 │"));
  EXPECT_THAT(text, HasSubstr("└╨"));
  EXPECT_EQ(count_of(plot_text(hill(), 60, 10), "\n"), 11);
}

TEST(Plot, SamePictureEveryTime) {
  EXPECT_EQ(plot_svg(hill()), plot_svg(hill()));
  EXPECT_EQ(plot_png(decay()), plot_png(decay()));
}

TEST(Plot, AnyCurveCanBeDrawn) {
  Dice dice(support::test_seed());
  curves::PlotOptions options;
  options.width_px = 200;
  options.height_px = 200;
  for (int round = 0; round < 60; ++round) {
    const NurbsCurve curve = random_curve(dice);
    const std::string svg = plot_svg(curve, options);
    EXPECT_EQ(count_of(svg, "nan") + count_of(svg, "inf"), 0) << svg;
    EXPECT_FALSE(plot_png(curve, options).empty());
    EXPECT_EQ(count_of(plot_text(curve), "\n"), 15);
  }
}

}  // namespace
}  // namespace knotwave::test
