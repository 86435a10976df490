// SPDX-License-Identifier: MIT
// The level of vector units reaches every kernel there is.
#include "knotwave/curves/simd.h"

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <hwy/targets.h>

#include "knotwave/curves/fast_program.h"
#include "knotwave/curves/moving_curve.h"

#include "support/simd_guard.h"

namespace {

using knotwave::curves::set_simd_level;
using knotwave::curves::simd_kernels_in_use;
using knotwave::curves::simd_level;
using knotwave::curves::simd_level_name;
using knotwave::curves::simd_levels;
using knotwave::curves::SimdLevel;
using knotwave::support::SimdGuard;
using testing::Each;
using testing::ElementsAre;

std::vector<std::string> families() {
  std::vector<std::string> names;
  for (const auto& use : simd_kernels_in_use()) names.push_back(use.family);
  return names;
}
std::vector<std::string> units() {
  std::vector<std::string> names;
  for (const auto& use : simd_kernels_in_use()) names.push_back(use.unit);
  return names;
}

/// Makes this a machine with fewer vector units; the real one at its end.
struct LesserMachine {
  explicit LesserMachine(std::int64_t units) { hwy::SetSupportedTargetsForTest(units); }
  ~LesserMachine() { hwy::SetSupportedTargetsForTest(0); }
};

TEST(Simd, EveryFamilyOfKernelsIsListed) {
  // A family is in the program when something that plays it is; nothing else here plays these two.
  using namespace knotwave::curves;
  EXPECT_EQ(FastProgram(CurveProgram()).fast_piece_count(), 1);
  const auto ease = NurbsCurve::create({.degree = 1, .dim = 2, .points = {0, 0, 1, 1}});
  const double points[] = {0, 0, 1, 1};
  EXPECT_EQ(MovingCurve::create(*ease)->at(0.5, points), 0.5);
  EXPECT_THAT(families(), ElementsAre("elementary functions", "grid in double", "grid in float",
                                      "moving curves", "wave tables"));
}

TEST(Simd, EveryKernelRunsOnTheUnitOfTheLevel) {
  std::set<std::string> seen;
  for (const SimdLevel level : simd_levels()) {
    const SimdGuard guard(level);
    EXPECT_EQ(simd_level(), level);
    EXPECT_THAT(units(), Each(std::string(simd_level_name()))) << to_string(level);
    if (level == SimdLevel::avx2) {
      EXPECT_STREQ(simd_level_name(), "AVX2");
    }
    seen.insert(simd_level_name());
  }
  // Three units where the processor has AVX-512; a build for it alone would have but one.
  if ((hwy::SupportedTargets() & HWY_AVX3) != 0 && (HWY_BASELINE_TARGETS & HWY_AVX2) == 0) {
    EXPECT_THAT(seen, testing::IsSupersetOf({"AVX2", "AVX3"}));
    EXPECT_EQ(seen.size(), 3u);
  }
}

#if HWY_ARCH_X86 && HWY_BASELINE_SSE4 == 0
TEST(Simd, AMachineWithoutAvx2SaysSoAndKeepsItsLevel) {
  const SimdGuard guard(SimdLevel::baseline);
  const LesserMachine machine(HWY_SSE4);
  EXPECT_THAT(simd_levels(), ElementsAre(SimdLevel::best, SimdLevel::baseline));
  const auto set = set_simd_level(SimdLevel::avx2);
  ASSERT_FALSE(set);
  EXPECT_EQ(set.error().message,
            "this processor has no AVX2: its best vector unit is SSE4; best and baseline work");
  EXPECT_EQ(simd_level(), SimdLevel::baseline);
}
#endif

}  // namespace
