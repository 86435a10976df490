// SPDX-License-Identifier: MIT
#include "knotwave/curves/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <regex>
#include <string>
#include <utility>
#include <vector>

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

/// Every text of a picture with where it is, as its letters are drawn in a PNG.
struct Label {
  std::string text;
  double left, right, base, size;
};
std::vector<Label> labels_of(const std::string& svg) {
  static const std::regex form(
      "<text x=\"([^\"]*)\" y=\"([^\"]*)\" font-size=\"([^\"]*)\" "
      "text-anchor=\"([^\"]*)\"[^>]*>([^<]*)<");
  std::vector<Label> labels;
  for (auto it = std::sregex_iterator(svg.begin(), svg.end(), form); it != std::sregex_iterator();
       ++it) {
    const auto& part = *it;
    Label label{part[5], std::stod(part[1]), 0, std::stod(part[2]), std::stod(part[3])};
    const double width = 0.5 * label.size * static_cast<double>(label.text.size());
    if (part[4] == "middle") label.left -= width / 2;
    if (part[4] == "end") label.left -= width;
    label.right = label.left + width;
    labels.push_back(label);
  }
  return labels;
}

/// All texts lie on the page and none lies on another; letters are taken as half as wide as high.
void expect_readable(const std::string& svg, double width) {
  const auto labels = labels_of(svg);
  EXPECT_GT(labels.size(), 8u);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const Label& a = labels[i];
    EXPECT_GE(a.left, 0) << a.text;
    EXPECT_LE(a.right, width) << a.text;
    for (std::size_t k = 0; k < i; ++k) {
      const Label& b = labels[k];
      const bool is_beside = a.right <= b.left || b.right <= a.left;
      const bool is_above = std::abs(a.base - b.base) >= 0.7 * std::min(a.size, b.size);
      EXPECT_TRUE(is_beside || is_above) << a.text << " lies on " << b.text;
    }
  }
}

TEST(Plot, TextsOfSmallPicturesDoNotMeetEachOtherOrTheEdge) {
  CurveSpec spec = decay().spec();
  for (const std::string& name : {std::string("decay60"), std::string(64, 'm')}) {
    spec.name = name;
    const auto curve = *NurbsCurve::create(spec);
    for (const auto& [width, height] : {std::pair{480, 270}, {320, 240}, {240, 200}, {960, 540}}) {
      curves::PlotOptions options;
      options.width_px = width;
      options.height_px = height;
      SCOPED_TRACE(name + " " + std::to_string(width));
      expect_readable(plot_svg(curve, options), width);
    }
  }
}

TEST(Plot, WeightsOfNearPointsAreWrittenApart) {
  CurveSpec spec;
  spec.name = "near";
  spec.degree = 3;
  spec.points = {0, 0.5, 0.5, 0.501, 0.5, 0.499, 0.5, 1};
  spec.weights = {1, 1.25, 2.5, 3.75, 1.5, 2.25, 1.125, 1};
  spec.knots = {0, 0, 0, 0, 0.5, 0.505, 0.51, 0.515, 1, 1, 1, 1};
  expect_readable(plot_svg(*NurbsCurve::create(spec)), 960);
}

TEST(Plot, TicksAreToldApart) {
  CurveSpec spec;
  spec.name = "narrow";
  spec.degree = 1;
  spec.points = {1000.001, 1000.002};
  const std::string svg = plot_svg(*NurbsCurve::create(spec));
  EXPECT_EQ(count_of(svg, ">1000<"), 0);
  EXPECT_THAT(svg, HasSubstr(">1000.001<"));
  EXPECT_THAT(svg, HasSubstr(">1000.0014<"));
  expect_readable(svg, 960);
  const std::string text = plot_text(*NurbsCurve::create(spec));
  EXPECT_THAT(text, HasSubstr(" 1000.002 │"));
  EXPECT_THAT(text, HasSubstr(" 1000.001 │"));
  spec.points = {1, 0};
  spec.knots = {1000.001, 1000.001, 1000.002, 1000.002};
  expect_readable(plot_svg(*NurbsCurve::create(spec)), 960);
}

TEST(Plot, AClosedCurveInAPlaneShowsTheKnotAtItsSeam) {
  const std::string dot = "r=\"3.2\" fill=\"#ffffff\"";
  CurveSpec spec;
  spec.name = "square";
  spec.degree = 1;
  spec.dim = 2;
  spec.points = {0, 0, 1, 0, 1, 1, 0, 1};
  spec.periodic = true;
  const int legend = 1;
  EXPECT_EQ(count_of(plot_svg(*NurbsCurve::create(spec)), dot), 4 + legend);
  spec.periodic = false;
  EXPECT_EQ(count_of(plot_svg(*NurbsCurve::create(spec)), dot), 2 + legend) << "open: no seam";
  spec.points.insert(spec.points.end(), {0, 0});
  EXPECT_EQ(count_of(plot_svg(*NurbsCurve::create(spec)), dot), 4 + legend);
}

TEST(Plot, SamePictureEveryTime) {
  EXPECT_EQ(plot_svg(hill()), plot_svg(hill()));
  EXPECT_EQ(plot_png(decay()), plot_png(decay()));
}

// 60 x 32 tiles, each outlined in its own colour; the last zone cuts 32 of them in thirds.
TEST(Plot, ATrimmedSurfaceShowsWhatIsKeptAndItsBorder) {
  const auto tiles = [](double u_high) {
    const auto zone = curves::TrimRegion::create(
        std::vector<curves::TrimLoop>{*curves::rectangle_loop(0, u_high, 0, 1)});
    const std::string svg = plot_svg(hill(), *zone);
    EXPECT_THAT(svg, HasSubstr("trimmed"));
    EXPECT_EQ(count_of(svg, "stroke=\"#222831\" stroke-width=\"2\""), 1);
    EXPECT_FALSE(plot_png(hill(), *zone).empty());
    return count_of(svg, "stroke-width=\"0.8\"");
  };
  EXPECT_EQ(tiles(1), 60 * 32);
  EXPECT_EQ(tiles(0.5), 30 * 32);
  EXPECT_EQ(tiles((30 + 2 / 6.0 + 0.01) / 60), 30 * 32 + 32 * 6 * 2);
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
