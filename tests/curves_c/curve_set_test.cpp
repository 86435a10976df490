// SPDX-License-Identifier: MIT
// Curve files, shapes, fits, paths and pictures through C.
#include <filesystem>

#include "knotwave/curves/curve_file.h"
#include "knotwave/curves/fit.h"
#include "knotwave/curves/plot.h"
#include "knotwave/curves/shapes.h"
#include "knotwave/curves/svg_path.h"

#include "c_handles.h"

namespace knotwave::c {
namespace {

using curves::NurbsCurve;

const std::string kText = R"(format = 1
kind   = "curve"
[curves.bell]
degree = 3
points = [0, 0.25, 1, 0]
[surfaces.hill]
degree_u = 1
degree_v = 1
points = [[0, 1], [2, 3]]
)";

TEST(CCurveSet, ReadsAndFinds) {
  const Set set = made<Set>(kw_curve_set_parse, kText.data(), kText.size(), "a.toml");
  EXPECT_EQ(kw_curve_set_curve_count(set.get()), 1u);
  EXPECT_EQ(kw_curve_set_surface_count(set.get()), 1u);
  const auto wanted = curves::parse_curves(kText, "a.toml");
  ASSERT_TRUE(wanted) << wanted.error().to_string();
  expect_same(kw_curve_set_curve_at(set.get(), 0), wanted->curves[0]);
  EXPECT_EQ(kw_curve_set_curve_at(set.get(), 1), nullptr);
  EXPECT_EQ(kw_surface_count_v(kw_curve_set_surface_at(set.get(), 0)), 2);
  EXPECT_EQ(kw_curve_set_surface_at(set.get(), 1), nullptr);
  const kw_curve* curve = nullptr;
  EXPECT_EQ(kw_curve_set_find_curve(set.get(), "bell", &curve, nullptr), KW_OK);
  EXPECT_EQ(curve, kw_curve_set_curve_at(set.get(), 0));
  const kw_surface* surface = nullptr;
  EXPECT_EQ(kw_curve_set_find_surface(set.get(), "hill", &surface, nullptr), KW_OK);
  EXPECT_EQ(surface, kw_curve_set_surface_at(set.get(), 0));
  EXPECT_EQ(refused<const kw_curve>(kw_curve_set_find_curve, set.get(), "bel").message,
            "there is no curve 'bel'; did you mean 'bell'?");
}

TEST(CCurveSet, WritesWhatItReadsBack) {
  const Set set = made<Set>(kw_curve_set_create);
  const Curve first = curve_of(bell()), second = curve_of(plain());
  ASSERT_EQ(kw_curve_set_add_curve(set.get(), first.get(), nullptr), KW_OK);
  const kw_curve* lent = kw_curve_set_curve_at(set.get(), 0);
  for (int i = 0; i < 100; ++i) {
    const Curve more =
        made<Curve>(kw_curve_renamed, second.get(), ("c" + std::to_string(i)).c_str());
    ASSERT_EQ(kw_curve_set_add_curve(set.get(), more.get(), nullptr), KW_OK);
  }
  EXPECT_EQ(lent, kw_curve_set_curve_at(set.get(), 0));
  EXPECT_EQ(kw_curve_set_add_curve(set.get(), first.get(), nullptr), KW_DUPLICATE_NAME);
  const Curve nameless = made<Curve>(kw_curve_renamed, first.get(), "");
  EXPECT_EQ(kw_curve_set_add_curve(set.get(), nameless.get(), nullptr), KW_MALFORMED);
  const Set other = made<Set>(kw_curve_set_parse, kText.data(), kText.size(), nullptr);
  ASSERT_EQ(kw_curve_set_add_surface(set.get(), kw_curve_set_surface_at(other.get(), 0), nullptr),
            KW_OK);

  const Text text = made<Text>(kw_curve_set_text, set.get());
  const Set again = made<Set>(kw_curve_set_parse, text.get(), std::string(text.get()).size(), "");
  EXPECT_EQ(kw_curve_set_curve_count(again.get()), 101u);
  EXPECT_TRUE(kw_curve_equal(kw_curve_set_curve_at(again.get(), 0), first.get()));

  const std::string path = testing::TempDir() + "knotwave_c_set.toml";
  ASSERT_EQ(kw_curve_set_write(set.get(), path.c_str(), nullptr), KW_OK);
  const Set read = made<Set>(kw_curve_set_read, path.c_str());
  EXPECT_EQ(kw_curve_set_curve_count(read.get()), 101u);
  std::filesystem::remove(path);
  EXPECT_EQ(refused<kw_curve_set>(kw_curve_set_read, path.c_str()).status, KW_FILE_NOT_FOUND);
  EXPECT_NE(kw_curve_set_write(set.get(), (path + "/x").c_str(), nullptr), KW_OK);
}

TEST(CShapes, AreThoseOfTheLibrary) {
  const double line[] = {0, 0.25, 1, 0.5}, p0[] = {1, 0}, p1[] = {1, 1}, p2[] = {0, 1};
  const double times[] = {0, 1, 3}, values[] = {0, 1, 0.5}, slopes[] = {0, 0.5, 0};
  const auto same = [](const Result<NurbsCurve>& wanted, auto call, auto... arguments) {
    expect_same(made<Curve>(call, arguments...).get(), wanted);
  };
  same(curves::bezier(line), kw_shape_bezier, line, size_t(4), 1);
  same(curves::arc(2, 0.1, -0.4), kw_shape_arc, 2.0, 0.1, -0.4);
  same(curves::ellipse(2, 3), kw_shape_ellipse, 2.0, 3.0);
  same(curves::conic(p0, p1, p2, 0.7), kw_shape_conic, p0, p1, p2, 0.7);
  same(curves::css_cubic_bezier(0.25, 0.1, 0.25, 1), kw_shape_css_cubic_bezier, 0.25, 0.1, 0.25,
       1.0);
  same(curves::hermite(times, values, slopes, slopes), kw_shape_hermite, times, size_t(3), values,
       slopes, slopes, size_t(3), 1);
  same(curves::catmull_rom(line, 2, 0.5, false), kw_shape_catmull_rom, line, size_t(4), 2, 0.5,
       false);
  kw_curve* out = nullptr;
  double error_db = 0;
  ASSERT_EQ(kw_shape_exponential_decay(60, &out, &error_db, nullptr), KW_OK);
  const Curve decay(out);
  const auto wanted = curves::exponential_decay(60);
  expect_same(out, wanted->curve);
  EXPECT_EQ(error_db, wanted->max_error_db);
  EXPECT_EQ(refused<kw_curve>(kw_shape_arc, -1.0, 0.0, 1.0).status, KW_VALUE_OUT_OF_RANGE);
}

TEST(CFit, IsThatOfTheLibrary) {
  const double times[] = {0, 1, 2, 4, 5, 7}, values[] = {0, 1, 0.5, 0.25, 0.75, 0};
  const auto spacing = curves::Spacing::chord;
  expect_same(made<Curve>(kw_curve_interpolate, values, size_t(6), 2, 2, KW_SPACING_CHORD).get(),
              curves::interpolate(values, 2, 2, spacing));
  expect_same(made<Curve>(kw_curve_interpolate_at, times, size_t(6), values, size_t(6), 1, 3).get(),
              curves::interpolate_at(times, values, 1, 3));
  kw_curve* out = nullptr;
  double bound = 0;
  ASSERT_EQ(kw_curve_approximate(times, 6, values, 6, 1, 3, 5, &out, &bound, nullptr), KW_OK);
  const Curve near(out);
  const auto fitted = curves::approximate(times, values, 1, 3, 5);
  expect_same(out, fitted->curve);
  EXPECT_EQ(bound, fitted->max_error);
  ASSERT_EQ(kw_curve_reduce_data(times, 6, values, 6, 1, 0.2, 3, &out, &bound, nullptr), KW_OK);
  const Curve few(out);
  const auto reduced = curves::reduce_data(times, values, 0.2);
  expect_same(out, reduced->curve);
  EXPECT_EQ(bound, reduced->max_error);
  ASSERT_EQ(kw_curve_reduce_data(times, 3, values, 6, 2, 0.2, 2, &out, &bound, nullptr), KW_OK);
  const Curve path(out);
  const auto both = curves::reduce_data(std::span(times).first(3), values, 0.2, 2, 2);
  expect_same(out, both->curve);
  EXPECT_EQ(bound, both->max_error);
  EXPECT_EQ(refused<kw_curve>(kw_curve_interpolate, values, size_t(6), 2, 2, 3).status,
            KW_VALUE_OUT_OF_RANGE);
}

TEST(CSvg, PathsAndPictures) {
  const std::string d = "M0 0C1 0 1 1 2 1";
  const Set set = made<Set>(kw_curve_set_from_svg_path, d.data(), d.size(), KW_SVG_Y_DOWN);
  const auto wanted = curves::curves_from_svg_path(d, curves::SvgY::down);
  const kw_curve* path = kw_curve_set_curve_at(set.get(), 0);
  expect_same(path, (*wanted)[0]);
  char* out = nullptr;
  double bound = -1;
  ASSERT_EQ(kw_curve_to_svg_path(path, 1e-6, KW_SVG_Y_DOWN, &out, &bound, nullptr), KW_OK);
  const Text text(out);
  EXPECT_EQ(std::string(out),
            curves::svg_path_from_curve((*wanted)[0], 1e-6, curves::SvgY::down)->d);
  EXPECT_EQ(refused<kw_curve_set>(kw_curve_set_from_svg_path, d.data(), d.size(), 2).status,
            KW_VALUE_OUT_OF_RANGE);
  const Text picture = made<Text>(kw_curve_plot_svg, path, 320, 200);
  curves::PlotOptions options;
  options.width_px = 320;
  options.height_px = 200;
  EXPECT_EQ(std::string(picture.get()), curves::plot_svg((*wanted)[0], options));
  const Set hill = made<Set>(kw_curve_set_parse, kText.data(), kText.size(), "");
  const Text shaded =
      made<Text>(kw_surface_plot_svg, kw_curve_set_surface_at(hill.get(), 0), 320, 200);
  EXPECT_EQ(std::string(shaded.get()).rfind("<svg", 0), 0u);
  EXPECT_EQ(refused<char>(kw_curve_plot_svg, path, 0, 200).status, KW_VALUE_OUT_OF_RANGE);
}

}  // namespace
}  // namespace knotwave::c
