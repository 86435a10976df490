// SPDX-License-Identifier: MIT
// What the instrument is told in a block, by every way.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace knotwave::bench {

inline constexpr std::size_t kBlock = 64;

/// Now and then a chord begins or ends, a parameter moves in every fourth block.
struct Told {
  std::vector<std::array<std::uint8_t, 3>> midi;
  double cutoff = 0;
  bool moves = false;
};

inline Told told_in(int block) {
  Told told;
  constexpr std::uint8_t kChord[] = {48, 55, 60, 64, 67, 71, 74, 79};
  if (block % 200 == 0) {
    for (const std::uint8_t key : kChord) told.midi.push_back({0x90, key, 100});
  } else if (block % 200 == 150) {
    for (const std::uint8_t key : kChord) told.midi.push_back({0x80, key, 64});
  }
  told.moves = block % 4 == 1;
  told.cutoff = -0.1 * (block % 40);
  return told;
}

}  // namespace knotwave::bench
