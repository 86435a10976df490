// SPDX-License-Identifier: MIT
// Maps inside the gate: what the audio thread may do with a MapSet it was handed.
#include <array>
#include <memory>

#include <gtest/gtest.h>

#include "knotwave/base/hand_over.h"
#include "knotwave/curves/map.h"

#include "rt_gate.h"

namespace knotwave::rt {
namespace {

using curves::Map1;
using curves::Map2;
using curves::MapSet;
using curves::MapValues;
using curves::Target;

class MapsInTheGate : public testing::TestWithParam<Gate> {};

std::unique_ptr<MapSet> everything() {
  curves::CurveSpec curve;
  curve.degree = 3;
  curve.points = {0, 1, 0.2, 0.6, 0.1, 0};
  curve.weights = {1, 2, 1, 0.5, 1, 1};
  curves::SurfaceSpec surface;
  surface.degree_u = surface.degree_v = 2;
  surface.count_u = surface.count_v = 4;
  surface.periodic_u = true;
  for (int i = 0; i < 16; ++i) surface.points.push_back(i % 5 - 2);
  auto maps = std::make_unique<MapSet>();
  const auto rational = curves::NurbsCurve::create(curve);
  curve.weights.clear();
  const auto plain = curves::NurbsCurve::create(curve);
  const auto morph = curves::NurbsSurface::create(surface);
  for (const Target target : {Target::amp, Target::pitch, Target::cutoff, Target::free_1}) {
    EXPECT_TRUE(maps->define(Map1{target, 0, 2, *rational}));
    EXPECT_TRUE(maps->define(Map1{target, 0, 2, *plain}));
    EXPECT_TRUE(maps->define(Map2{target, 0, 1, 0, 1, *morph}));
  }
  return maps;
}

TEST_P(MapsInTheGate, EnablingEvaluatingAndSettingWhatIsCurrent) {
  base::HandOver<MapSet> hand_over(2);
  std::array<double, 256> first{}, second{};
  const std::array<MapSet::Channel, 2> channels = {
      {{Target::amp, 0, first}, {Target::pan, 0, second}}};
  MapValues values, slopes;
  double sum = 0;
  const auto work = [&] {
    MapSet* maps = hand_over.acquire();
    if (maps == nullptr) return;
    for (const bool rational : {false, true}) {
      maps->enable({Target::amp, 1, 1, rational});
      maps->enable({Target::pitch, 1, 1, rational}, rational);
      maps->enable({Target::amp, 2, 1, false});
      maps->set_current(Target::pan, std::array{0.25});
      for (int i = -2; i < 30; ++i) {
        maps->evaluate(0.1 * i, values);
        maps->evaluate(0.1 * i, 0.03 * i, slopes);
        maps->evaluate_slopes(0.1 * i, slopes);
        maps->evaluate_slopes(0.1 * i, 0.03 * i, values, slopes);
        sum += values.of(Target::amp)[0];
      }
      maps->evaluate_grid({0, 2, 1000}, 400, channels);
      maps->evaluate_mesh({0, 1, 63}, 0, 64, {0, 1, 3}, 0, channels);
    }
    hand_over.release(maps);
  };
  const auto prepare = [&] {  // once outside of the gate: code and stack are touched
    hand_over.publish(everything());
    work();
    hand_over.collect();
    hand_over.publish(everything());
    sum = 0;
    second.fill(0);
  };
  const GateReport report = run_in_gate(GetParam(), work, prepare);
  EXPECT_EQ(report.findings(), "");
  EXPECT_EQ(second[255], 0.25);
  EXPECT_NE(sum, 0);
}

INSTANTIATE_TEST_SUITE_P(Both, MapsInTheGate, testing::Values(Gate::sanitizer, Gate::system),
                         [](const auto& gate) {
                           return gate.param == Gate::sanitizer ? "sanitizer" : "system";
                         });

}  // namespace
}  // namespace knotwave::rt
