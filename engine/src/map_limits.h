// SPDX-License-Identifier: MIT
// How far maps may move a voice. What they add up to is held to these, so that a voice is finite
// whatever a patch asks; docs/engine.md lists them.
#pragma once
#include <algorithm>

#include "chunk_signal.h"

namespace knotwave::engine {

inline constexpr double kMostDb = 120;      ///< a level or drive, upwards
inline constexpr double kMostGain = 1e6;    ///< of a source and of a voice: 120 dB
inline constexpr double kMostOctaves = 30;  ///< a cutoff, the speed of an LFO
inline constexpr double kMostFree = 1e6;    ///< a free number, either way, where a map reads it

/// Gain of a level in dB, which is at most kMostDb.
inline Signal limited_gain_of_db(const Signal& db, std::size_t n, ChunkBuffer& buffer) KNOTWAVE_RT {
  return gain_of_db(mapped(db, n, buffer, [](double x) { return std::min(x, kMostDb); }), n,
                    buffer);
}
inline double limited_free(double x) KNOTWAVE_RT { return std::clamp(x, -kMostFree, kMostFree); }
/// 1 + x, from 0 to kMostGain.
inline Signal limited_factor(const Signal& x, std::size_t n, ChunkBuffer& buffer) KNOTWAVE_RT {
  return mapped(x, n, buffer, [](double moved) { return std::clamp(1 + moved, 0.0, kMostGain); });
}
/// At most kMostGain either way.
inline Signal limited_gain(const Signal& gain, std::size_t n, ChunkBuffer& buffer) KNOTWAVE_RT {
  return mapped(gain, n, buffer, [](double x) { return std::clamp(x, -kMostGain, kMostGain); });
}
/// 2^x, x at most kMostOctaves either way.
inline Signal limited_power_of_2(const Signal& octaves, std::size_t n,
                                 ChunkBuffer& buffer) KNOTWAVE_RT {
  return power_of_2(mapped(octaves, n, buffer,
                           [](double x) { return std::clamp(x, -kMostOctaves, kMostOctaves); }),
                    n, buffer);
}

}  // namespace knotwave::engine
