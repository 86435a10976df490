// SPDX-License-Identifier: MIT
// Edits and analyses through C give the curves and numbers of C++, to the bit.
#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/analysis.h"
#include "knotwave/curves/bezier.h"
#include "knotwave/curves/calculus.h"
#include "knotwave/curves/combine.h"
#include "knotwave/curves/monotone.h"
#include "knotwave/curves/reduce.h"
#include "knotwave/curves/reparametrize.h"

#include "c_handles.h"

namespace knotwave::c {
namespace {

using curves::NurbsCurve;

class CEdit : public testing::Test {
 protected:
  const NurbsCurve bell_ = *NurbsCurve::create(bell());
  const NurbsCurve plain_ = *NurbsCurve::create(plain());
  const Curve c_bell_ = curve_of(bell());
  const Curve c_plain_ = curve_of(plain());
  const kw_curve* const b_ = c_bell_.get();
  const kw_curve* const p_ = c_plain_.get();
};

/// Calls that give one curve, whatever else they tell.
template <class Call, class... Arguments>
void expect_made(const Result<NurbsCurve>& wanted, Call call, Arguments... arguments) {
  expect_same(made<Curve>(call, arguments...).get(), wanted);
}

TEST_F(CEdit, WhatKeepsTheCurve) {
  const double knots[] = {0.75, 0.25, 0.25};
  expect_made(curves::insert_knot(bell_, 0.3, 2), kw_curve_insert_knot, b_, 0.3, 2);
  expect_made(curves::refine(bell_, knots), kw_curve_refine, b_, knots, size_t(3));
  expect_made(curves::elevate_degree(bell_, 2), kw_curve_elevate_degree, b_, 2);
  expect_made(curves::sub_curve(bell_, 0.2, 0.7), kw_curve_part, b_, 0.2, 0.7);
  expect_made(curves::reverse(bell_), kw_curve_reverse, b_);
  expect_made(curves::reparametrize(bell_, 2, 5), kw_curve_reparametrize, b_, 2.0, 5.0);
  expect_made(curves::bend(bell_, 3), kw_curve_bend, b_, 3.0);
}

TEST_F(CEdit, SplitGivesBothPartsOrNone) {
  kw_curve *left = nullptr, *right = nullptr;
  ASSERT_EQ(kw_curve_split(b_, 0.4, &left, &right, nullptr), KW_OK);
  const Curve own_left(left), own_right(right);
  const auto wanted = curves::split(bell_, 0.4);
  expect_same(left, wanted->left);
  expect_same(right, wanted->right);
  kw_error* error = nullptr;
  EXPECT_EQ(kw_curve_split(b_, 2, &left, &right, &error), KW_PARAMETER_OUT_OF_RANGE);
  const Fault fault(error);
  EXPECT_EQ(left, nullptr);
  EXPECT_EQ(right, nullptr);
  EXPECT_EQ(kw_curve_split(b_, 0.4, &left, nullptr, nullptr), KW_NULL_ARGUMENT);
  EXPECT_EQ(left, nullptr);
}

TEST_F(CEdit, TwoOutputsAtOnePlaceAreRefused) {
  kw_curve* out = nullptr;
  kw_error* error = nullptr;
  EXPECT_EQ(kw_curve_split(b_, 0.4, &out, &out, &error), KW_MALFORMED);
  const Fault fault(error);
  EXPECT_STREQ(kw_error_message(error), "both outputs are one place: give each its own");
  EXPECT_EQ(kw_curve_make_compatible(b_, p_, &out, &out, nullptr), KW_MALFORMED);
  EXPECT_EQ(out, nullptr);
}

TEST_F(CEdit, CountsThatNoArrayHasAreRefused) {
  const double knot = 0.5;
  const double* const one = &knot;
  const Failure endless = refused<kw_curve>(kw_curve_refine, b_, one, size_t{1} << 61);
  EXPECT_EQ(endless.status, KW_VALUE_OUT_OF_RANGE);
  EXPECT_EQ(endless.message,
            "'knots' cannot have 2305843009213693952 elements: no memory holds them");
  const Failure many = refused<kw_curve>(kw_curve_refine, b_, one, size_t{4113});
  EXPECT_EQ(many.status, KW_TOO_MANY_POINTS);
  EXPECT_EQ(many.message, "knots_count is 4113, at most 4112 are possible");
  EXPECT_EQ(refused<kw_curve>(kw_curve_interpolate, one, SIZE_MAX, 1, 3, KW_SPACING_CHORD).status,
            KW_VALUE_OUT_OF_RANGE);
}

TEST_F(CEdit, WhatMakesItSmallerSaysByHowMuch) {
  kw_curve* out = nullptr;
  int32_t removed = -1;
  double bound = -1;
  ASSERT_EQ(kw_curve_remove_knot(p_, 0.5, 2, 0.5, &out, &removed, &bound, nullptr), KW_OK);
  const Curve without(out);
  const auto one = curves::remove_knot(plain_, 0.5, 2, 0.5);
  expect_same(out, one->curve);
  EXPECT_EQ(removed, one->removed);
  EXPECT_EQ(bound, one->max_error);
  ASSERT_EQ(kw_curve_remove_knots(p_, 0.5, &out, &removed, &bound, nullptr), KW_OK);
  const Curve simple(out);
  const auto many = curves::remove_knots(plain_, 0.5);
  expect_same(out, many->curve);
  EXPECT_EQ(removed, many->removed);
  EXPECT_EQ(bound, many->max_error);
  ASSERT_EQ(kw_curve_reduce_degree(p_, 0.5, &out, &bound, nullptr), KW_OK);
  const Curve lower(out);
  const auto quadratic = curves::reduce_degree(plain_, 0.5);
  expect_same(out, quadratic->curve);
  EXPECT_EQ(bound, quadratic->max_error);
  EXPECT_EQ(kw_curve_reduce_degree(p_, 1e-9, &out, nullptr, nullptr), KW_ERROR_BOUND_MISSED);
  EXPECT_EQ(out, nullptr);
}

TEST_F(CEdit, HandlesThatSendTimeBackAreRepaired) {
  const curves::CurveSpec loop = {
      .name = "loop", .degree = 3, .dim = 2, .points = {0, 0, 1.5, 0.5, -0.75, 0.5, 1, 1}};
  const Curve curve = curve_of(loop);
  const curves::Regularization modes[] = {
      curves::Regularization::contain, curves::Regularization::keep_start,
      curves::Regularization::keep_ratio, curves::Regularization::limit_active,
      curves::Regularization::limit_opposite};
  for (int i = 0; i < 5; ++i) {
    const kw_regularization mode = KW_REGULARIZE_CONTAIN + i;
    expect_made(curves::regularize(*NurbsCurve::create(loop), modes[i]), kw_curve_regularize,
                curve.get(), mode);
    double a = 1.5, b = 1.25;
    EXPECT_EQ(kw_regularize_handles(&a, &b, mode, false), KW_OK);
    const auto wanted = curves::regularize_handles({1.5, 1.25}, modes[i], false);
    EXPECT_EQ(a, wanted.a);
    EXPECT_EQ(b, wanted.b);
    EXPECT_TRUE(kw_is_monotone_cubic(a, b));
  }
  EXPECT_FALSE(kw_is_monotone_cubic(1.5, 1.25));
  EXPECT_EQ(refused<kw_curve>(kw_curve_regularize, curve.get(), 6).status, KW_VALUE_OUT_OF_RANGE);
  EXPECT_EQ(kw_regularize_handles(nullptr, nullptr, 0, true), KW_NULL_ARGUMENT);
}

TEST_F(CEdit, TwoCurvesMakeOne) {
  const NurbsCurve quadratic =
      *NurbsCurve::create({.name = "ramp", .degree = 2, .points = {0, 0.25, 1}});
  const Curve c_quadratic = curve_of(quadratic.spec());
  const kw_curve* const q = c_quadratic.get();
  expect_made(curves::join(plain_, quadratic), kw_curve_join, p_, q, 0.0);
  expect_made(curves::morph(bell_, quadratic, 0.25), kw_curve_morph, b_, q, 0.25);
  expect_made(curves::sum(bell_, quadratic), kw_curve_sum, b_, q);
  expect_made(curves::product(bell_, quadratic), kw_curve_product, b_, q);
  expect_made(curves::compose(bell_, quadratic), kw_curve_compose, b_, q);
  kw_curve *first = nullptr, *second = nullptr;
  ASSERT_EQ(kw_curve_make_compatible(b_, q, &first, &second, nullptr), KW_OK);
  const Curve own_first(first), own_second(second);
  const auto both = curves::make_compatible(bell_, quadratic);
  expect_same(first, both->first);
  expect_same(second, both->second);
}

TEST_F(CEdit, SlopesAreasAndLengths) {
  expect_made(curves::hodograph(plain_), kw_curve_hodograph, p_);
  expect_made(curves::antiderivative(plain_, 2), kw_curve_antiderivative, p_, 2.0);
  double area = 0;
  EXPECT_EQ(kw_curve_integral(p_, 0.1, 0.9, 0, &area, nullptr), KW_OK);
  EXPECT_EQ(area, *curves::integral(plain_, 0.1, 0.9));
  EXPECT_EQ(kw_curve_integral(p_, 0.1, 0.9, 1, &area, nullptr), KW_DIMENSION_MISMATCH);
  EXPECT_EQ(refused<kw_curve>(kw_curve_antiderivative, b_, 0.0).status, KW_UNSUPPORTED);
  double length = 0, u = 0;
  EXPECT_EQ(kw_curve_arc_length(b_, 0.1, 0.9, &length, nullptr), KW_OK);
  EXPECT_EQ(length, *curves::arc_length(bell_, 0.1, 0.9));
  EXPECT_EQ(kw_curve_parameter_at_length(b_, length, &u, nullptr), KW_OK);
  EXPECT_EQ(u, *curves::parameter_at_length(bell_, length));
  EXPECT_EQ(kw_curve_parameter_at_length(b_, 99, &u, nullptr), KW_PARAMETER_OUT_OF_RANGE);
}

TEST_F(CEdit, BezierSegmentsAndBack) {
  const Bezier segments = made<Bezier>(kw_curve_to_bezier, b_);
  EXPECT_EQ(kw_bezier_segment_count(segments.get()), 2u);
  EXPECT_EQ(kw_bezier_degree(segments.get()), 3);
  EXPECT_EQ(kw_bezier_dim(segments.get()), 1);
  size_t ends_count = 0, points_count = 0, weights_count = 0;
  const double* ends = kw_bezier_ends(segments.get(), &ends_count);
  const double* points = kw_bezier_points(segments.get(), &points_count);
  const double* weights = kw_bezier_weights(segments.get(), &weights_count);
  EXPECT_EQ(std::vector<double>(ends, ends + ends_count), (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(points_count, 8u);
  const auto wanted = curves::from_bezier(curves::to_bezier(bell_));
  expect_made(wanted, kw_curve_from_bezier, 3, 1, ends, ends_count, points, points_count, weights,
              weights_count, 0.0);
  EXPECT_EQ(refused<kw_curve>(kw_curve_from_bezier, 3, 1, ends, ends_count, points, size_t(7),
                              weights, weights_count, 0.0)
                .message,
            "7 numbers of points, 8 are needed");
  EXPECT_EQ(refused<kw_curve>(kw_curve_from_bezier, 16, 1, ends, ends_count, points, points_count,
                              weights, weights_count, 0.0)
                .status,
            KW_DEGREE_OUT_OF_RANGE);
}

std::vector<double> taken(kw_doubles from) {
  std::vector<double> numbers(from.numbers, from.numbers + from.count);
  kw_doubles_free(&from);
  EXPECT_EQ(from.numbers, nullptr);
  return numbers;
}

TEST_F(CEdit, Analyses) {
  kw_extremum low{}, high{};
  ASSERT_EQ(kw_curve_value_range(b_, 0, &low, &high, nullptr), KW_OK);
  const auto range = curves::value_range(bell_);
  EXPECT_EQ(low.u, range.low.u);
  EXPECT_EQ(high.value, range.high.value);
  double least = 0, most = 0, number = 0;
  ASSERT_EQ(kw_curve_hull_range(b_, 0, &least, &most, nullptr), KW_OK);
  EXPECT_EQ(least, -0.25);
  EXPECT_EQ(most, 1);
  ASSERT_EQ(kw_curve_total_variation(b_, 0, &number, nullptr), KW_OK);
  EXPECT_EQ(number, curves::total_variation(bell_));
  bool rises = true;
  ASSERT_EQ(kw_curve_is_non_decreasing(b_, 0, &rises, nullptr), KW_OK);
  EXPECT_FALSE(rises);
  kw_doubles out{};
  ASSERT_EQ(kw_curve_parameters_at(b_, 0.3, 0, &out, nullptr), KW_OK);
  EXPECT_EQ(taken(out), curves::parameters_at(bell_, 0.3));
  ASSERT_EQ(kw_curve_parameters_at(b_, 5, 0, &out, nullptr), KW_OK);
  EXPECT_EQ(out.count, 0u);
  ASSERT_EQ(kw_curve_greville_abscissae(b_, &out, nullptr), KW_OK);
  EXPECT_EQ(taken(out), curves::greville_abscissae(bell_));
  ASSERT_EQ(kw_curve_span_hulls(b_, 0, &out, nullptr), KW_OK);
  const auto hulls = curves::span_hulls(bell_);
  const std::vector<double> rows = taken(out);
  ASSERT_EQ(rows.size(), 4 * hulls.size());
  EXPECT_EQ(rows[4], hulls[1].u0);
  EXPECT_EQ(rows[7], hulls[1].high);
  ASSERT_EQ(kw_curve_breaks(b_, 3, 0, &out, nullptr), KW_OK);
  const auto breaks = curves::breaks_of(bell_, 3);
  ASSERT_EQ(breaks.size(), 1u);
  EXPECT_EQ(taken(out), (std::vector<double>{0.5, double(breaks[0].order), breaks[0].size}));
  EXPECT_EQ(kw_curve_breaks(b_, 1001, 0, &out, nullptr), KW_VALUE_OUT_OF_RANGE);
  const double point = 0.4;
  ASSERT_EQ(kw_curve_closest_point(b_, &point, 1, &number, &least, nullptr), KW_OK);
  const auto nearest = curves::closest_point(bell_, {&point, 1});
  EXPECT_EQ(number, nearest->u);
  EXPECT_EQ(least, nearest->distance);
}

TEST_F(CEdit, ACoordinateThatIsNotThereIsAnError) {
  for (const int32_t coordinate : {-1, 1}) {
    kw_error* error = nullptr;
    double number = 7;
    EXPECT_EQ(kw_curve_total_variation(b_, coordinate, &number, &error), KW_DIMENSION_MISMATCH);
    const Fault fault(error);
    EXPECT_EQ(number, 7);
    EXPECT_EQ(std::string(kw_error_message(error)),
              "curve 'bell' has no coordinate " + std::to_string(coordinate) + ", only 0 to 0");
  }
}

}  // namespace
}  // namespace knotwave::c
