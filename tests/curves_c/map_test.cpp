// SPDX-License-Identifier: MIT
// Maps through C: the numbers of C++, to the bit; no allocation; an answer for every input.
#include "knotwave/curves/map.h"

#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "c_handles.h"
#include "support/allocation_count.h"

namespace knotwave::c {
namespace {

using curves::Map1;
using curves::Map2;
using curves::MapSet;
using curves::MapValues;
using curves::Target;

curves::SurfaceSpec hill() {
  curves::SurfaceSpec spec;
  spec.name = "hill";
  spec.degree_u = spec.degree_v = 2;
  spec.count_u = spec.count_v = 3;
  spec.points = {0, 1, 0, 0.5, 2, -1, 0, 1, 0.25};
  return spec;
}

Surface surface_of(const curves::SurfaceSpec& spec) {
  kw_surface_spec from = KW_SURFACE_SPEC_INIT;
  from.name = spec.name.c_str();
  from.degree_u = spec.degree_u;
  from.degree_v = spec.degree_v;
  from.count_u = spec.count_u;
  from.count_v = spec.count_v;
  from.points = spec.points.data();
  from.points_count = spec.points.size();
  return made<Surface>(kw_surface_create, &from);
}

void expect_same(const kw_map_values& made, const MapValues& wanted) {
  for (std::size_t t = 0; t < KW_TARGET_COUNT; ++t) {
    EXPECT_EQ(made.width[t], wanted.width[t]) << t;
    EXPECT_EQ(made.evaluated[t], wanted.evaluated[t]) << t;
    for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(made.numbers[t][c], wanted.numbers[t][c]) << t;
  }
}

class CMaps : public testing::Test {
 protected:
  CMaps() {
    EXPECT_EQ(kw_map_set_define_curve(s_, KW_TARGET_AMP, 0, 2, curve_.get(), 1e-7, &amp_, nullptr),
              KW_OK);
    EXPECT_EQ(kw_map_set_define_surface(s_, KW_TARGET_WAVE_POSITION, 0, 1, 3, 1, surface_.get(),
                                        &wave_, nullptr),
              KW_OK);
    EXPECT_TRUE(kw_map_set_enable(s_, &amp_, true));
    EXPECT_TRUE(kw_map_set_enable(s_, &wave_, true));
    const double pan = 0.25;
    EXPECT_EQ(kw_map_set_set_current(s_, KW_TARGET_PAN, &pan, 1), KW_OK);
    theirs_.enable(*theirs_.define(Map1{Target::amp, 0, 2, *curves::NurbsCurve::create(bell())}));
    theirs_.enable(*theirs_.define(
        Map2{Target::wave_position, 0, 1, 3, 1, *curves::NurbsSurface::create(hill())}));
    theirs_.set_current(Target::pan, std::array{0.25});
  }

  const Curve curve_ = curve_of(bell());
  const Surface surface_ = surface_of(hill());
  const Maps set_ = made<Maps>(kw_map_set_create);
  kw_map_set* const s_ = set_.get();
  kw_map_key amp_{}, wave_{};
  MapSet theirs_;
};

TEST_F(CMaps, TargetsHaveTheNumbersOfTheLibrary) {
  constexpr std::array<std::string_view, KW_TARGET_COUNT> kNames = {
      "amp",    "pitch",     "pan",        "phase",     "wave_position",
      "cutoff", "resonance", "drive",      "crossfade", "control_point",
      "weight", "knot",      "time_scale", "position",  "modulation",
      "free_1", "free_2",    "free_3",     "free_4"};
  for (kw_target t = 0; t < KW_TARGET_COUNT; ++t) {
    EXPECT_EQ(kw_target_name(t), kNames[std::size_t(t)]);
    EXPECT_EQ(kw_target_widest(t), t < KW_TARGET_POSITION ? 1 : t == KW_TARGET_POSITION ? 3 : 4);
  }
  for (const kw_target none : {-1, KW_TARGET_COUNT}) {
    EXPECT_EQ(kw_target_name(none), nullptr);
    EXPECT_EQ(kw_target_widest(none), 0);
  }
}

TEST_F(CMaps, AreEvaluatedAsInTheLibrary) {
  EXPECT_TRUE(amp_.rational);
  EXPECT_EQ(amp_.width, 1);
  EXPECT_EQ(wave_.parameters, 2);
  kw_map_values made{}, by_u{}, by_v{};
  MapValues wanted, wanted_u, wanted_v;
  for (const double u : {-1.0, 0.0, 0.3, 1.0, 1.7, 2.0, std::nan("")}) {
    ASSERT_EQ(kw_map_set_evaluate(s_, u, &made), KW_OK);
    theirs_.evaluate(u, wanted);
    expect_same(made, wanted);
    ASSERT_EQ(kw_map_set_evaluate_uv(s_, u, 1 + u, &made), KW_OK);
    theirs_.evaluate(u, 1 + u, wanted);
    expect_same(made, wanted);
    ASSERT_EQ(kw_map_set_slopes(s_, u, &by_u), KW_OK);
    theirs_.evaluate_slopes(u, wanted_u);
    expect_same(by_u, wanted_u);
    ASSERT_EQ(kw_map_set_slopes_uv(s_, u, 1 + u, &by_u, &by_v), KW_OK);
    theirs_.evaluate_slopes(u, 1 + u, wanted_u, wanted_v);
    expect_same(by_u, wanted_u);
    expect_same(by_v, wanted_v);
  }
  size_t count = 0;
  EXPECT_EQ(kw_map_set_current(s_, KW_TARGET_PAN, &count)[0], 0.25);
  EXPECT_EQ(count, 1u);
}

TEST_F(CMaps, GridsAndMeshesAreThoseOfTheLibraryWithoutAllocation) {
  std::array<double, 100> amp{}, pan{}, mesh{}, wanted_amp{}, wanted_mesh{};
  const std::array<kw_map_channel, 2> channels = {
      {{KW_TARGET_AMP, 0, amp.data(), amp.size()}, {KW_TARGET_PAN, 0, pan.data(), pan.size()}}};
  const kw_map_channel wave{KW_TARGET_WAVE_POSITION, 0, mesh.data(), mesh.size()};
  const kw_map_grid grid{0, 2, 99}, grid_u{0, 1, 9}, grid_v{1, 3, 9};
  kw_map_values values{};
  const auto play = [&] {
    EXPECT_EQ(kw_map_set_evaluate_grid(s_, &grid, 0, channels.data(), 2), KW_OK);
    EXPECT_EQ(kw_map_set_evaluate_mesh(s_, &grid_u, 0, 10, &grid_v, 0, &wave, 1), KW_OK);
    EXPECT_EQ(kw_map_set_evaluate(s_, 0.5, &values), KW_OK);
    EXPECT_TRUE(kw_map_set_enable(s_, &amp_, true));
  };
  EXPECT_EQ(support::allocations_in(play), 0);
  const MapSet::Channel to_amp{Target::amp, 0, wanted_amp};
  const MapSet::Channel to_mesh{Target::wave_position, 0, wanted_mesh};
  theirs_.evaluate_grid({0, 2, 99}, 0, {&to_amp, 1});
  theirs_.evaluate_mesh({0, 1, 9}, 0, 10, {1, 3, 9}, 0, {&to_mesh, 1});
  EXPECT_EQ(amp, wanted_amp);
  EXPECT_EQ(mesh, wanted_mesh);
  EXPECT_EQ(pan[99], 0.25);
}

TEST_F(CMaps, WhatWasDefinedIsGivenBack) {
  double range[4] = {};
  const Curve curve = made<Curve>(kw_map_set_get_curve, s_, &amp_, range);
  EXPECT_TRUE(kw_curve_equal(curve.get(), curve_.get()));
  EXPECT_EQ(range[1], 2);
  const Surface surface = made<Surface>(kw_map_set_get_surface, s_, &wave_, range);
  EXPECT_TRUE(kw_surface_equal(surface.get(), surface_.get()));
  EXPECT_EQ(range[2], 3);
  EXPECT_EQ(range[3], 1);
  kw_map_key other = amp_;
  other.target = KW_TARGET_PITCH;
  const auto none = refused<kw_curve>(kw_map_set_get_curve, s_, &other, range);
  EXPECT_EQ(none.status, KW_UNKNOWN_NAME);
  EXPECT_EQ(none.message, "the set has no map of pitch with this key");
  EXPECT_EQ(refused<kw_surface>(kw_map_set_get_surface, s_, &amp_, range).status, KW_UNKNOWN_NAME);
  EXPECT_EQ(refused<kw_curve>(kw_map_set_get_curve, s_, nullptr, range).status, KW_NULL_ARGUMENT);
}

TEST_F(CMaps, WhatIsNoneHasAnAnswer) {
  EXPECT_TRUE(kw_map_set_is_enabled(s_, &amp_));
  EXPECT_TRUE(kw_map_set_enable(s_, &amp_, false));
  EXPECT_FALSE(kw_map_set_is_enabled(s_, &amp_));
  kw_map_key other = amp_;
  other.target = 99;
  EXPECT_FALSE(kw_map_set_enable(s_, &other, true));
  EXPECT_FALSE(kw_map_set_enable(nullptr, &amp_, true));
  EXPECT_FALSE(kw_map_set_is_enabled(s_, nullptr));
  const double one = 1;
  EXPECT_EQ(kw_map_set_set_current(s_, 99, &one, 1), KW_VALUE_OUT_OF_RANGE);
  EXPECT_EQ(kw_map_set_set_current(s_, KW_TARGET_PAN, nullptr, 1), KW_NULL_ARGUMENT);
  EXPECT_EQ(kw_map_set_current(s_, -1, nullptr), nullptr);
  std::array<double, 4> out = {9, 9, 9, 9};
  const kw_map_channel none{99, 0, out.data(), out.size()};
  const kw_map_channel nowhere{KW_TARGET_AMP, 0, nullptr, 4};
  const kw_map_grid grid{0, 1, 3};
  EXPECT_EQ(kw_map_set_evaluate_grid(s_, &grid, 0, &none, 1), KW_VALUE_OUT_OF_RANGE);
  EXPECT_EQ(out, (std::array<double, 4>{}));
  EXPECT_EQ(kw_map_set_evaluate_grid(s_, &grid, 0, &nowhere, 1), KW_NULL_ARGUMENT);
  EXPECT_EQ(kw_map_set_evaluate_grid(s_, nullptr, 0, &none, 1), KW_NULL_ARGUMENT);
  EXPECT_EQ(kw_map_set_evaluate_mesh(s_, &grid, 0, 0, &grid, 0, &none, 1), KW_VALUE_OUT_OF_RANGE);
  EXPECT_EQ(kw_map_set_evaluate(s_, 0, nullptr), KW_NULL_ARGUMENT);
  EXPECT_EQ(kw_map_set_evaluate_uv(nullptr, 0, 0, nullptr), KW_NULL_ARGUMENT);
  EXPECT_EQ(kw_map_set_slopes(s_, 0, nullptr), KW_NULL_ARGUMENT);
  EXPECT_EQ(kw_map_set_slopes_uv(s_, 0, 0, nullptr, nullptr), KW_NULL_ARGUMENT);
}

TEST_F(CMaps, ARefusedDefinitionSaysWhy) {
  kw_error* error = nullptr;
  EXPECT_EQ(kw_map_set_define_curve(s_, KW_TARGET_AMP, 1, 1, curve_.get(), 1e-7, nullptr, &error),
            KW_EMPTY_DOMAIN);
  EXPECT_STREQ(kw_error_message(error), "map of amp: u1 and u2 are both 1");
  kw_error_free(error);
  EXPECT_EQ(kw_map_set_define_curve(s_, 19, 0, 1, curve_.get(), 1e-7, nullptr, &error),
            KW_VALUE_OUT_OF_RANGE);
  EXPECT_STREQ(kw_error_message(error), "the target is 19, no number of 0 to 18");
  kw_error_free(error);
  EXPECT_EQ(kw_map_set_define_surface(s_, KW_TARGET_AMP, 0, 1, 0, 1, nullptr, nullptr, &error),
            KW_NULL_ARGUMENT);
  kw_error_free(error);
}

}  // namespace
}  // namespace knotwave::c
