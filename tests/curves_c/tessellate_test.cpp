// SPDX-License-Identifier: MIT
// Few straight steps through C: what C++ calls, in its order.
#include "knotwave/curves/tessellate.h"

#include <string>

#include "c_handles.h"

namespace knotwave::c {
namespace {

TEST(CTessellate, CallsAreThoseOfTheLibrary) {
  std::vector<double> made, wanted;
  curves::TessellatorCalls theirs;
  theirs.begin = theirs.end = [&](double u) { wanted.push_back(u); };
  theirs.value = theirs.slope = [&](double u, std::span<const double> numbers) {
    wanted.push_back(u);
    wanted.insert(wanted.end(), numbers.begin(), numbers.end());
  };
  ASSERT_TRUE(tessellate(*curves::NurbsCurve::create(bell()), curves::MaxError{-60, 0.5}, theirs));

  kw_tessellator calls = KW_TESSELLATOR_INIT;
  calls.user = &made;
  calls.begin = calls.end = [](void* user, double u) {
    static_cast<std::vector<double>*>(user)->push_back(u);
  };
  calls.value = calls.slope = [](void* user, double u, const double* numbers, size_t dim) {
    auto& all = *static_cast<std::vector<double>*>(user);
    all.push_back(u);
    all.insert(all.end(), numbers, numbers + dim);
  };
  const Curve curve = curve_of(bell());
  const kw_sampling sampling = {KW_SAMPLING_MAX_ERROR, 0, -60, 0.5};
  EXPECT_EQ(kw_curve_tessellate(curve.get(), &sampling, &calls, 1 << 20, nullptr), KW_OK);
  EXPECT_EQ(made, wanted);
  const kw_tessellator nobody = KW_TESSELLATOR_INIT;
  EXPECT_EQ(kw_curve_tessellate(curve.get(), &sampling, &nobody, 1 << 20, nullptr), KW_OK);
}

TEST(CTessellate, AJumpStandsTwiceAmongTheParameters) {
  const Curve curve = curve_of({.name = "two lines",
                                .degree = 1,
                                .points = {0, 2, 7, 9},
                                .knots = {0, 0, 1, 1, 2, 2},
                                .jumps = {1}});
  const auto sampled = [&](const kw_sampling& sampling) {
    kw_doubles out = {};
    EXPECT_EQ(kw_curve_sample_parameters(curve.get(), &sampling, 0, 2, 1000, &out, nullptr), KW_OK);
    std::vector<double> all(out.numbers, out.numbers + out.count);
    kw_doubles_free(&out);
    return all;
  };
  EXPECT_EQ(sampled({KW_SAMPLING_FIXED_STEP, 0, 2, 0}),
            (std::vector<double>{0, 0.5, 1, 1, 1.5, 2}));
  EXPECT_EQ(sampled({KW_SAMPLING_MAX_ERROR, 0, -90, 1}), (std::vector<double>{0, 1, 1, 2}));
  EXPECT_EQ(sampled({KW_SAMPLING_MAX_STEP, 0, 2, 0}), (std::vector<double>{0, 1, 1, 2}));
}

TEST(CTessellate, FaultsAreToldAndNothingIsCalled) {
  const Curve curve = curve_of(bell());
  int called = 0;
  kw_tessellator calls = KW_TESSELLATOR_INIT;
  calls.user = &called;
  calls.begin = [](void* user, double) { ++*static_cast<int*>(user); };
  const auto message = [&](const kw_sampling& sampling, kw_status wanted) {
    kw_error* error = nullptr;
    EXPECT_EQ(kw_curve_tessellate(curve.get(), &sampling, &calls, 100, &error), wanted);
    const Fault fault(error);
    return std::string(kw_error_message(error));
  };
  EXPECT_EQ(message({3, 0, 1, 1}, KW_VALUE_OUT_OF_RANGE),
            "the sampling method is 3, no number of 0 to 2");
  EXPECT_EQ(message({KW_SAMPLING_MAX_STEP, 5, 1, 0}, KW_VALUE_OUT_OF_RANGE),
            "the sampling's reserved is 5, not 0");
  EXPECT_EQ(message({KW_SAMPLING_MAX_STEP, 0, 0, 0}, KW_VALUE_OUT_OF_RANGE),
            "curve 'bell': size = 0 is not positive and finite");
  message({KW_SAMPLING_FIXED_STEP, 0, 100, 0}, KW_TOO_MANY_POINTS);
  calls.struct_size = 0;
  message({KW_SAMPLING_FIXED_STEP, 0, 10, 0}, KW_UNSUPPORTED_VERSION);
  EXPECT_EQ(called, 0);
  kw_doubles out = {};
  EXPECT_EQ(kw_curve_sample_parameters(curve.get(), nullptr, 0, 1, 9, &out, nullptr),
            KW_NULL_ARGUMENT);
}

}  // namespace
}  // namespace knotwave::c
