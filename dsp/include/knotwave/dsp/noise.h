// SPDX-License-Identifier: MIT
// White noise from the counter-based generator: sample i is a function of (stream, i).
#pragma once
#include <cstdint>
#include <span>

#include "knotwave/base/random.h"

namespace knotwave::dsp {

/// Uniform white noise in [-1, 1), rms 1/sqrt(3) (-4.77 dBFS); sample first + i. [audio]
void render_noise(base::RandomStream stream, std::int64_t first, std::span<float> out) KNOTWAVE_RT;

}  // namespace knotwave::dsp
