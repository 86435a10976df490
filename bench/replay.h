// SPDX-License-Identifier: MIT
// What a block of the live engine costs, free of what else the machine does: one script of messages
// is played several times over by new engines, and of each block the shortest time counts.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "knotwave/engine/bank.h"

namespace knotwave::bench {

inline constexpr double kRateHz = 48000;
inline constexpr int kBlockFrames = 64;
inline constexpr double kDeadlineUs = kBlockFrames * 1e6 / kRateHz;

/// A message and where it is heard.
struct Played {
  int block = 0;
  int offset = 0;  ///< samples into the block
  std::array<std::uint8_t, 3> bytes{};
};

struct Script {
  std::vector<Played> messages;  ///< in order of time
  /// Through the ring of an input, stamped, as of a MIDI cable; else as a block's exact ones.
  bool through_ring = false;
  int swap_block = -1;  ///< the same bank, compiled again, is installed at its start; -1: never
  int blocks = 0;
};

struct Setup {
  int max_voices = 64;
  int threads = 1;
  int replays = 5;
};

struct Replay {
  std::vector<double> us;    ///< of each block, the least of all replays
  std::vector<int> voices;   ///< that sounded when the block ended
  std::int64_t dropped = 0;  ///< notes without a voice
  std::string sha256;        ///< of the samples, the same in each replay
};

/// Ends the program with a message where the engine cannot be made or two replays differ.
Replay replay(const engine::BankSpec& bank, const Script& script, const Setup& setup);

/// p in 0..100, nearest rank. Not of nothing.
double percentile(std::vector<double> values, double p);

}  // namespace knotwave::bench
