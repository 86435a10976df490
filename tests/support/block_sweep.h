// SPDX-License-Identifier: MIT
// Any split of a block into smaller blocks gives the same bits.
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

namespace knotwave::support {

/// `fresh()` returns a renderer in its first state: a callable (std::size_t first,
/// std::span<Float> out) that fills out with the samples from `first` on and remembers. All of
/// `samples` in one block must equal all in blocks of 1, 2 ... 130, to the bit.
template <class Float, class Fresh>
void expect_block_size_does_not_matter(std::size_t samples, Fresh&& fresh) {
  using Bits = std::conditional_t<sizeof(Float) == 4, std::uint32_t, std::uint64_t>;
  std::vector<Float> whole(samples), split(samples);
  {
    auto render = fresh();
    render(std::size_t{0}, std::span<Float>(whole));
  }
  for (std::size_t size = 1; size <= 130; ++size) {
    auto render = fresh();
    for (std::size_t first = 0; first < samples; first += size) {
      render(first, std::span<Float>(split).subspan(first, std::min(size, samples - first)));
    }
    for (std::size_t i = 0; i < samples; ++i) {
      ASSERT_EQ(std::bit_cast<Bits>(whole[i]), std::bit_cast<Bits>(split[i]))
          << "sample " << i << ", blocks of " << size << ": " << whole[i] << " and " << split[i];
    }
  }
}

}  // namespace knotwave::support
