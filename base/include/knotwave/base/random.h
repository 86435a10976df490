// SPDX-License-Identifier: MIT
// Counter-based random numbers: number i of stream k is a pure function of (seed, k, i), so order,
// threads and block size do not matter. Philox4x32-10 (Salmon, Moraes, Dror, Shaw, "Parallel random
// numbers: as easy as 1, 2, 3", SC 2011); known-answer vectors in tests/base/random_test.cpp.
#pragma once
#include <array>
#include <cstdint>

#include "knotwave/base/rt.h"

namespace knotwave::base {

/// The ten-round Philox4x32 block function. [any] Cost: 20 multiplications, 60 other operations.
constexpr std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                  std::array<std::uint32_t, 2> key) KNOTWAVE_RT {
  auto [c0, c1, c2, c3] = counter;
  auto [k0, k1] = key;
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53} * c0;
    const std::uint64_t p1 = std::uint64_t{0xCD9E8D57} * c2;
    c0 = static_cast<std::uint32_t>(p1 >> 32) ^ c1 ^ k0;
    c1 = static_cast<std::uint32_t>(p1);
    c2 = static_cast<std::uint32_t>(p0 >> 32) ^ c3 ^ k1;
    c3 = static_cast<std::uint32_t>(p0);
    k0 += 0x9E3779B9u;
    k1 += 0xBB67AE85u;
  }
  return {c0, c1, c2, c3};
}

/// A named stream of random numbers.
struct RandomStream {
  std::uint64_t seed = 0;     ///< the patch seed
  std::uint32_t voice = 0;    ///< which note, counted from engine time 0
  std::uint32_t purpose = 0;  ///< one constant per use; see below

  /// Number `index` of the stream, uniform over 64 bits. [any]
  constexpr std::uint64_t bits(std::uint64_t index) const KNOTWAVE_RT {
    const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
    const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); };
    const auto block =
        philox4x32({low(index), high(index), voice, purpose}, {low(seed), high(seed)});
    return block[0] | std::uint64_t{block[1]} << 32;
  }
  /// Uniform in [0, 1), 53 bits. [any]
  double unit(std::uint64_t index) const KNOTWAVE_RT;
  /// Uniform in [-1, 1), 54 bits. [any]
  double bipolar(std::uint64_t index) const KNOTWAVE_RT;
};

/// Purposes in use; numbers never change, because they are part of the sound.
inline constexpr std::uint32_t kRandomNoise = 1;
inline constexpr std::uint32_t kRandomLfo = 2;
inline constexpr std::uint32_t kRandomPhase = 3;
inline constexpr std::uint32_t kRandomMap = 4;
inline constexpr std::uint32_t kRandomDither = 5;

}  // namespace knotwave::base
