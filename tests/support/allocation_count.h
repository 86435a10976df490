// SPDX-License-Identifier: MIT
// Counts this thread's allocations: a test binary that uses it gets our operator new.
#pragma once
#include <cstdint>

namespace knotwave::support {

/// Allocations through operator new by this thread since the program began.
std::int64_t allocation_count() noexcept;
/// Those of all threads that were not deleted yet.
std::int64_t live_objects() noexcept;

/// EXPECT_EQ(allocations_in([&] { voice.render(out); }), 0);
template <class Work>
std::int64_t allocations_in(Work&& work) {
  const std::int64_t before = allocation_count();
  work();
  return allocation_count() - before;
}

}  // namespace knotwave::support
