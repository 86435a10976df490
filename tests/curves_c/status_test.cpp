// SPDX-License-Identifier: MIT
// Errors, versions and ownership of the C interface.
#include <thread>

#include "c_handles.h"

namespace knotwave::c {
namespace {

TEST(CStatus, NumbersAreThoseOfTheFirstAbi) {
  EXPECT_EQ(KW_OK, 0);
  EXPECT_EQ(KW_DEGREE_OUT_OF_RANGE, 10);
  EXPECT_EQ(KW_CONTROL_CONFLICT, 28);
  EXPECT_EQ(KW_FILE_NOT_FOUND, 40);
  EXPECT_EQ(KW_UNSUPPORTED, 55);
  EXPECT_EQ(kw_abi_version(), 1);
  EXPECT_EQ(kw_version(), 100 * KW_VERSION_MINOR + KW_VERSION_PATCH);
}

TEST(CStatus, EveryErrorOfTheCurveLibraryHasANumberAndItsName) {
  for (int i = 0; i <= int(base::ErrorCode::unsupported); ++i) {
    const auto code = base::ErrorCode(i);
    if (code == base::ErrorCode::usage || code == base::ErrorCode::interrupted) continue;
    int found = 0;
    for (kw_status status = 1; status < 100; ++status) {
      found += std::string(kw_status_name(status)) == base::to_string(code);
    }
    EXPECT_EQ(found, 1) << base::to_string(code);
  }
  EXPECT_STREQ(kw_status_name(KW_OK), "ok");
  EXPECT_STREQ(kw_status_name(-5), "unknown");
}

TEST(CStatus, AnErrorSaysWhatTheLibrarySays) {
  curves::CurveSpec spec = bell();
  spec.knots[5] = 0.25;
  const auto wanted = curves::NurbsCurve::create(spec);
  ASSERT_FALSE(wanted);
  kw_curve_spec from = KW_CURVE_SPEC_INIT;
  from.name = "bell";
  from.points = spec.points.data();
  from.points_count = spec.points.size();
  from.knots = spec.knots.data();
  from.knots_count = spec.knots.size();
  const Failure failure = refused<kw_curve>(kw_curve_create, &from);
  EXPECT_EQ(failure.status, KW_KNOTS_DECREASE);
  EXPECT_EQ(failure.message, wanted.error().message);
  EXPECT_EQ(failure.text, wanted.error().to_string());
}

TEST(CStatus, AFileFaultHasItsPlace) {
  const std::string text = "format = 1\nkind = \"curve\"\n[curves.a]\npoints = [0, x]\n";
  kw_curve_set* set = nullptr;
  kw_error* error = nullptr;
  EXPECT_EQ(kw_curve_set_parse(text.data(), text.size(), "a.toml", &set, &error), KW_SYNTAX);
  const Fault fault(error);
  EXPECT_EQ(set, nullptr);
  EXPECT_STREQ(kw_error_source(error), "a.toml");
  EXPECT_EQ(kw_error_line(error), 4);
  EXPECT_GT(kw_error_column(error), 0);
  EXPECT_EQ(std::string(kw_error_text(error)).rfind("a.toml:4:", 0), 0u);
}

TEST(CStatus, ANullPointerIsNamed) {
  const Failure failure = refused<kw_curve>(kw_curve_reverse, (const kw_curve*)nullptr);
  EXPECT_EQ(failure.status, KW_NULL_ARGUMENT);
  EXPECT_EQ(failure.message, "argument 'curve' is NULL");
  const Curve curve = curve_of(bell());
  EXPECT_EQ(kw_curve_reverse(curve.get(), nullptr, nullptr), KW_NULL_ARGUMENT);
  EXPECT_EQ(
      refused<kw_curve>(kw_curve_refine, curve.get(), (const double*)nullptr, size_t(2)).message,
      "argument 'knots' is NULL");
  made<Curve>(kw_curve_refine, curve.get(), (const double*)nullptr, size_t(0));
}

void expect_null(const Failure& failure, const std::string& name) {
  EXPECT_EQ(failure.status, KW_NULL_ARGUMENT) << name;
  EXPECT_EQ(failure.message, "argument '" + name + "' is NULL");
}

TEST(CStatus, ANullMemberOfASpecIsANullArgument) {
  const double points[] = {0, 1};
  kw_curve_spec spec = KW_CURVE_SPEC_INIT;
  spec.points_count = 2;
  expect_null(refused<kw_curve>(kw_curve_create, &spec), "spec->points");
  spec.points = points;
  spec.weights_count = 2;
  expect_null(refused<kw_curve>(kw_curve_create, &spec), "spec->weights");
  spec.weights = points;
  spec.knots_count = 1;
  expect_null(refused<kw_curve>(kw_curve_create, &spec), "spec->knots");
  spec.knots = points;
  spec.jumps_count = 1;
  expect_null(refused<kw_curve>(kw_curve_create, &spec), "spec->jumps");

  kw_surface_spec surface = KW_SURFACE_SPEC_INIT;
  surface.points = points;
  surface.points_count = 2;
  surface.knots_v_count = 1;
  expect_null(refused<kw_surface>(kw_surface_create, &surface), "spec->knots_v");
  surface.knots_u_count = 1;
  expect_null(refused<kw_surface>(kw_surface_create, &surface), "spec->knots_u");
  surface.weights_count = 1;
  expect_null(refused<kw_surface>(kw_surface_create, &surface), "spec->weights");
  surface.points = nullptr;
  expect_null(refused<kw_surface>(kw_surface_create, &surface), "spec->points");

  const Curve curve = curve_of(bell());
  kw_compile_options options = KW_COMPILE_OPTIONS_INIT;
  options.controls_count = 1;
  expect_null(refused<kw_program>(kw_compile_function, curve.get(), &options), "options->controls");
  expect_null(refused<kw_join_program>(kw_compile_join, curve.get(), 0.5, &options),
              "options->controls");
}

TEST(CStatus, ANullAmongCurvesIsANullArgument) {
  const Curve curve = curve_of(bell());
  const kw_curve* const curves[] = {curve.get(), nullptr};
  kw_curve* out[] = {nullptr, nullptr};
  kw_error* error = nullptr;
  EXPECT_EQ(kw_curve_make_all_compatible(curves, 2, out, 2, &error), KW_NULL_ARGUMENT);
  EXPECT_STREQ(kw_error_message(error), "argument 'curves[1]' is NULL");
  kw_error_free(error);
  const size_t sizes[] = {2};
  const kw_curve* const* const rows = curves;
  expect_null(
      refused<kw_trim_region>(kw_trim_region_create, rows, size_t{2}, &sizes[0], size_t{1}, 1e-9),
      "curves[1]");
  const double* const evenly = nullptr;
  expect_null(refused<kw_surface>(kw_surface_lofted, rows, size_t{2}, 1, evenly, size_t{0}),
              "rows[1]");
}

TEST(CStatus, ErrorsMayBeLeftOutAndNullMayBeFreed) {
  kw_curve* curve = nullptr;
  kw_curve_spec spec = KW_CURVE_SPEC_INIT;
  EXPECT_EQ(kw_curve_create(&spec, &curve, nullptr), KW_TOO_FEW_POINTS);
  kw_error_free(nullptr);
  kw_curve_free(nullptr);
  kw_surface_free(nullptr);
  kw_program_free(nullptr);
  kw_curve_set_free(nullptr);
  kw_bezier_free(nullptr);
  kw_text_free(nullptr);
  kw_doubles_free(nullptr);
}

TEST(CStatus, ASpecWithoutItsInitIsRefused) {
  kw_curve_spec spec{};
  EXPECT_EQ(refused<kw_curve>(kw_curve_create, &spec).status, KW_UNSUPPORTED_VERSION);
  kw_surface_spec surface{};
  EXPECT_EQ(refused<kw_surface>(kw_surface_create, &surface).status, KW_UNSUPPORTED_VERSION);
  kw_compile_options options{};
  const Curve curve = curve_of(bell());
  EXPECT_EQ(refused<kw_program>(kw_compile_function, curve.get(), &options).status,
            KW_UNSUPPORTED_VERSION);
}

TEST(CStatus, WhatIsAskedOfNoHandleIsNothing) {
  size_t count = 7;
  EXPECT_EQ(kw_curve_name(nullptr), nullptr);
  EXPECT_EQ(kw_curve_degree(nullptr), 0);
  EXPECT_EQ(kw_curve_knots(nullptr, &count), nullptr);
  EXPECT_EQ(count, 0u);
  EXPECT_FALSE(kw_curve_equal(nullptr, nullptr));
  EXPECT_EQ(kw_surface_dim(nullptr), 0);
  EXPECT_EQ(kw_program_piece_count(nullptr), 0);
  EXPECT_EQ(kw_program_at(nullptr, 0, 0, nullptr, 0), 0);
  EXPECT_EQ(kw_curve_set_curve_count(nullptr), 0u);
  EXPECT_EQ(kw_bezier_segment_count(nullptr), 0u);
  EXPECT_STREQ(kw_error_message(nullptr), "");
}

TEST(CStatus, ThreadsThatFailAtOnceGetTheirOwnErrors) {
  const Curve curve = curve_of(bell());
  std::vector<std::string> messages(4);
  std::vector<std::thread> threads;
  for (size_t t = 0; t < messages.size(); ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 200; ++i) {
        kw_curve* out = nullptr;
        kw_error* error = nullptr;
        kw_curve_insert_knot(curve.get(), 2.0 + double(t), 1, &out, &error);
        messages[t] = kw_error_message(error);
        kw_error_free(error);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (size_t t = 0; t < messages.size(); ++t) {
    EXPECT_NE(messages[t].find(std::to_string(t + 2)), std::string::npos) << messages[t];
  }
}

}  // namespace
}  // namespace knotwave::c
