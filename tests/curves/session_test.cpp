// SPDX-License-Identifier: MIT
#include "knotwave/curves/session.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace knotwave::test {
namespace {

using curves::CurveSession;
using curves::CurveSpec;
using curves::FixedStep;
using curves::MapValues;
using curves::MaxError;
using curves::NurbsCurve;
using curves::SessionCalls;
using curves::Target;
using testing::ElementsAre;
using testing::HasSubstr;

NurbsCurve made(std::vector<double> points, std::vector<double> knots = {}, int dim = 1) {
  CurveSpec spec;
  spec.name = "example";
  spec.dim = dim;
  spec.degree = 1;
  spec.points = std::move(points);
  spec.knots = std::move(knots);
  auto curve = NurbsCurve::create(std::move(spec));
  EXPECT_TRUE(curve) << (curve ? "" : curve.error().message);
  return std::move(*curve);
}

/// What a session says, as words.
struct Listener {
  std::string told;
  SessionCalls calls;

  Listener() {
    calls.begin = [this](double u) { told += "begin" + number(u); };
    calls.value = [this](double u, auto value) { told += "value" + number(u) + number(value[0]); };
    calls.attribute = [this](Target target, double u, auto value) {
      told += to_string(target) + number(u) + number(value[0]);
    };
    calls.end = [this](double u) { told += "end" + number(u); };
  }
  static std::string number(double x) {
    std::string text = std::to_string(x);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return " " + text + " ";
  }
};

ErrorCode code_of(const Result<void>& outcome) {
  EXPECT_FALSE(outcome);
  return outcome ? ErrorCode::unsupported : outcome.error().code;
}

TEST(Session, AttributesAreValuesAtThePlacesOfTheCurve) {
  CurveSession session;
  Listener listener;
  ASSERT_TRUE(session.begin());
  ASSERT_TRUE(session.attribute(Target::pitch, made({60, 72}, {0, 0, 4, 4})));
  ASSERT_TRUE(session.curve(Target::amp, made({0, 1, 0}, {0, 0, 1, 2, 2})));
  ASSERT_TRUE(session.attribute(Target::pan, made({0, 8, 8}, {0, 0, 0.5, 1, 1})));
  ASSERT_TRUE(session.end(listener.calls));
  EXPECT_EQ(listener.told,
            "begin 0 value 0  0 pitch 0  60 pan 0  0 value 1  1 pitch 1  63 pan 1  8 "
            "value 2  0 pitch 2  66 pan 2  8 end 2 ");
}

TEST(Session, ExactlyOneCurveAndOneAttributeATarget) {
  CurveSession session;
  EXPECT_EQ(code_of(session.curve(Target::amp, made({0, 1}))), ErrorCode::usage);
  EXPECT_EQ(code_of(session.attribute(Target::amp, made({0, 1}))), ErrorCode::usage);
  EXPECT_EQ(code_of(session.keep(0, 1)), ErrorCode::usage);
  EXPECT_EQ(code_of(session.end({})), ErrorCode::usage);
  EXPECT_FALSE(session.end_as_maps());
  ASSERT_TRUE(session.begin());
  EXPECT_EQ(code_of(session.begin()), ErrorCode::usage);
  ASSERT_TRUE(session.attribute(Target::pan, made({0, 1})));
  EXPECT_EQ(code_of(session.attribute(Target::pan, made({0, 1}))), ErrorCode::duplicate_name);
  EXPECT_EQ(code_of(session.curve(Target::pan, made({0, 1}))), ErrorCode::duplicate_name);
  EXPECT_EQ(code_of(session.curve(Target::amp, made({0, 1, 2, 3}, {}, 2))),
            ErrorCode::dimension_mismatch);
  ASSERT_TRUE(session.curve(Target::amp, made({0, 1})));
  EXPECT_EQ(code_of(session.curve(Target::pitch, made({0, 1}))), ErrorCode::usage);
  EXPECT_EQ(code_of(session.attribute(Target::amp, made({0, 1}))), ErrorCode::duplicate_name);
  Listener listener;
  ASSERT_TRUE(session.end(listener.calls)) << "what was refused changed nothing";
  EXPECT_EQ(listener.told, "begin 0 value 0  0 pan 0  0 value 1  1 pan 1  1 end 1 ");

  ASSERT_TRUE(session.begin());
  const auto missing = session.end({});
  EXPECT_EQ(code_of(missing), ErrorCode::usage);
  EXPECT_EQ(missing.error().message, "session: end() without a curve() since begin()");
  EXPECT_TRUE(session.begin()) << "the failed end closed it";
}

TEST(Session, ANumberThatIsNoTargetIsRefused) {
  CurveSession session;
  ASSERT_TRUE(session.begin());
  for (const int number : {-1, 99}) {
    const auto target = static_cast<Target>(number);
    EXPECT_EQ(code_of(session.curve(target, made({0, 1}))), ErrorCode::value_out_of_range);
    EXPECT_EQ(code_of(session.attribute(target, made({0, 1}))), ErrorCode::value_out_of_range);
  }
}

TEST(Session, SamplingStaysAcrossCurves) {
  CurveSession session(FixedStep{4});
  for (int round = 0; round < 2; ++round) {
    int values = 0;
    SessionCalls calls;
    calls.value = [&](double, auto) { ++values; };
    ASSERT_TRUE(session.begin());
    ASSERT_TRUE(session.curve(Target::amp, made({0, 1})));
    ASSERT_TRUE(session.end(calls));
    EXPECT_EQ(values, 5);
  }
  session.set_sampling(FixedStep{-1});
  ASSERT_TRUE(session.begin());
  ASSERT_TRUE(session.curve(Target::amp, made({0, 1})));
  EXPECT_EQ(code_of(session.end({})), ErrorCode::value_out_of_range);
}

TEST(Session, KeepsPartsOfTheCurve) {
  CurveSession session;
  Listener listener;
  ASSERT_TRUE(session.begin());
  ASSERT_TRUE(session.curve(Target::amp, made({0, 10})));
  ASSERT_TRUE(session.keep(0, 0.25));
  ASSERT_TRUE(session.keep(0.5, 0.75));
  EXPECT_EQ(code_of(session.keep(0.7, 1)), ErrorCode::knots_decrease);
  EXPECT_EQ(code_of(session.keep(0.9, 0.8)), ErrorCode::empty_domain);
  ASSERT_TRUE(session.end(listener.calls));
  EXPECT_EQ(listener.told,
            "begin 0 value 0  0 value 0.25  2.5 end 0.25 begin 0.5 value 0.5  5 value 0.75  7.5 "
            "end 0.75 ");
  ASSERT_TRUE(session.begin());
  ASSERT_TRUE(session.curve(Target::amp, made({0, 10})));
  ASSERT_TRUE(session.keep(0.5, 1.5));
  EXPECT_EQ(code_of(session.end({})), ErrorCode::parameter_out_of_range);
  ASSERT_TRUE(session.begin());
  ASSERT_TRUE(session.curve(Target::amp, made({0, 10})));
  ASSERT_TRUE(session.keep(0.5, 1));
  const auto maps = session.end_as_maps();
  ASSERT_FALSE(maps);
  EXPECT_EQ(maps.error().code, ErrorCode::unsupported);
}

TEST(Session, TheSameCurveAsStepsOrAsMaps) {
  CurveSession session;
  ASSERT_TRUE(session.begin());
  ASSERT_TRUE(session.curve(Target::amp, made({0, 1}, {0, 0, 2, 2})));
  ASSERT_TRUE(session.attribute(Target::pitch, made({60, 72}, {0, 0, 4, 4})));
  const auto maps = session.end_as_maps();
  ASSERT_TRUE(maps) << maps.error().message;
  MapValues out;
  maps->evaluate(1, out);
  EXPECT_EQ(out.of(Target::amp)[0], 0.5);
  EXPECT_EQ(out.of(Target::pitch)[0], 63);
  EXPECT_FALSE(out.is_evaluated(Target::pan));
}

TEST(Session, ValuesOfAllPartsAreCountedTogether) {
  CurveSession session(FixedStep{100});
  ASSERT_TRUE(session.begin());
  ASSERT_TRUE(session.curve(Target::amp, made({0, 10})));
  ASSERT_TRUE(session.keep(0, 0.25));
  ASSERT_TRUE(session.keep(0.5, 0.75));
  EXPECT_EQ(code_of(session.end({}, 51)), ErrorCode::too_many_points);
}

}  // namespace
}  // namespace knotwave::test
