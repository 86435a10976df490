// SPDX-License-Identifier: MIT
// Elementary functions over spans.
#include "knotwave/base/elementary.h"

#include <cstddef>

namespace knotwave::base {

void exp2(std::span<const double> in, std::span<double> out) KNOTWAVE_RT {
  const std::size_t count = in.size() < out.size() ? in.size() : out.size();
  for (std::size_t i = 0; i < count; ++i) out[i] = exp2(in[i]);
}

}  // namespace knotwave::base
