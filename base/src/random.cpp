// SPDX-License-Identifier: MIT
// Random numbers from the Philox block function.
#include "knotwave/base/random.h"

namespace knotwave::base {

double RandomStream::unit(std::uint64_t index) const KNOTWAVE_RT {
  return static_cast<double>(bits(index) >> 11) * 0x1p-53;
}

double RandomStream::bipolar(std::uint64_t index) const KNOTWAVE_RT {
  return static_cast<double>(static_cast<std::int64_t>(bits(index)) >> 10) * 0x1p-53;
}

}  // namespace knotwave::base
