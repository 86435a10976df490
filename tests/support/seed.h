// SPDX-License-Identifier: MIT
// Seeds of property tests: KNOTWAVE_SEED chooses, the test prints what it used.
#pragma once
#include <cstdint>

namespace knotwave::support {

/// The seed of this run (1 unless KNOTWAVE_SEED says otherwise), recorded in the test's output.
std::uint64_t test_seed();

/// `normal`, or `normal` times KNOTWAVE_SCALE when that is set (long runs by label).
int test_count(int normal);

}  // namespace knotwave::support
