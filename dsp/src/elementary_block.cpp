// SPDX-License-Identifier: MIT
#include "knotwave/dsp/elementary_block.h"

#include <algorithm>

#include "elementary_kernel.h"

namespace knotwave::dsp {

void exp2(std::span<const double> in, std::span<double> out) KNOTWAVE_RT {
  elementary_kernels_in_use().exp2(in.data(), out.data(), std::min(in.size(), out.size()));
}

void db_to_gain(std::span<const double> in, std::span<double> out) KNOTWAVE_RT {
  elementary_kernels_in_use().db_to_gain(in.data(), out.data(), std::min(in.size(), out.size()));
}

void note_increments(std::span<const double> notes, double rate_hz,
                     std::span<base::Phase> out) KNOTWAVE_RT {
  const std::size_t n = std::min(notes.size(), out.size());
  if (!(rate_hz > 0)) {
    std::fill_n(out.begin(), n, base::Phase{});
    return;
  }
  elementary_kernels_in_use().note_increments(notes.data(), rate_hz, out.data(), n);
}

void phase_ramp(base::Phase first, base::Phase increment, double origin, double width,
                std::span<double> out) KNOTWAVE_RT {
  elementary_kernels_in_use().phase_ramp(first, increment, origin, width, out.data(), out.size());
}

}  // namespace knotwave::dsp
