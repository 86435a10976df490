// SPDX-License-Identifier: MIT
// Degrees, spans and counts are ints, because they are subtracted; containers want std::size_t.
#pragma once
#include <cstddef>

namespace knotwave::base {

/// i >= 0 as an index. [any]
constexpr std::size_t index_of(int i) noexcept { return static_cast<std::size_t>(i); }

}  // namespace knotwave::base
