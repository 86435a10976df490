// SPDX-License-Identifier: MIT
// Random numbers from the Philox block function.
#include "knotwave/base/random.h"

namespace knotwave::base {
namespace {
constexpr std::uint32_t low_word(std::uint64_t x) { return static_cast<std::uint32_t>(x); }
constexpr std::uint32_t high_word(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); }
}  // namespace

std::uint64_t RandomStream::bits(std::uint64_t index) const KNOTWAVE_RT {
  const auto block = philox4x32({low_word(index), high_word(index), voice, purpose},
                                {low_word(seed), high_word(seed)});
  return block[0] | std::uint64_t{block[1]} << 32;
}

double RandomStream::unit(std::uint64_t index) const KNOTWAVE_RT {
  return static_cast<double>(bits(index) >> 11) * 0x1p-53;
}

double RandomStream::bipolar(std::uint64_t index) const KNOTWAVE_RT {
  return static_cast<double>(static_cast<std::int64_t>(bits(index)) >> 10) * 0x1p-53;
}

}  // namespace knotwave::base
