// SPDX-License-Identifier: MIT
// What the parts of plugin_cost share.
#pragma once
#include <string_view>

namespace knotwave::bench {

inline constexpr double kRate = 48000;

/// One way to play the instrument through a test's own host: "lv2" or "vst3". The sum of a sample
/// of every block; NaN where there is no such way.
double by_host(std::string_view way, int blocks);
/// One way to play an effect, such as "shaper" (its class) or "shaper-dsp" (what it is made of).
double by_effect(std::string_view way, int blocks);

}  // namespace knotwave::bench
