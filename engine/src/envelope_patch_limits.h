// SPDX-License-Identifier: MIT
// What numbers the outputs of an envelope patch may have. [control]
#pragma once
#include <algorithm>
#include <string_view>

#include "knotwave/engine/envelope_patch.h"

namespace knotwave::engine {

inline constexpr int kLastControl = 119;     ///< above are channel mode messages
inline constexpr int kLastFineControl = 31;  ///< that has a low half, 32 above it
inline constexpr int kLastNrpn = 16383;
inline constexpr int kMaxVoltageChannels = 64;
inline constexpr double kMostVolts = 20;
inline constexpr double kMostOscValue = 1e9;
inline constexpr double kMostOscHz = 1000;
inline constexpr double kLeastEventSeconds = 1e-4, kMostEventSeconds = 60;

/// Of an output's `low`, `high` and `rest`: what its destination has room for, and the usual range.
struct OutputLimits {
  double low = 0, high = 127;
  double usual_low = 0, usual_high = 127;
};
inline OutputLimits limits_of(const OutputSpec& output) {
  switch (output.kind) {
    case OutputKind::control:
    case OutputKind::nrpn:
      return output.bits == 14 ? OutputLimits{0, 16383, 0, 16383} : OutputLimits{};
    case OutputKind::pitch_bend:
      return {-8192, 8191, -8192, 8191};
    case OutputKind::channel_pressure:
    case OutputKind::poly_pressure:
      return {};
    case OutputKind::osc:
      return {-kMostOscValue, kMostOscValue, 0, 1};
    case OutputKind::voltage:
      return {-kMostVolts, kMostVolts, 0, 5};
  }
  return {};
}

/// Begins with '/', printable ASCII, none of the characters that mean patterns (OSC 1.0).
inline bool is_osc_address(std::string_view address) {
  constexpr std::string_view kPatterns = "#*,?[]{}";
  return address.size() > 1 && address.size() <= 256 && address.front() == '/' &&
         std::all_of(address.begin(), address.end(), [&](char c) {
           return c > ' ' && c <= '~' && kPatterns.find(c) == std::string_view::npos;
         });
}

}  // namespace knotwave::engine
