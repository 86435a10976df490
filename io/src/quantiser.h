// SPDX-License-Identifier: MIT
// Private to io: floats to integers of 16 or 24 bits, dithered and clipped.
#pragma once
#include <cstdint>
#include <span>

namespace knotwave::io {

/// Triangular dither of one LSB each way, which makes the mean and the power of the rounding error
/// independent of the sound (Lipshitz, Wannamaker, Vanderkooy, "Quantization and dither: a
/// theoretical survey", J. Audio Eng. Soc. 40(5), 1992). It is a pure function of seed, channel and
/// frame, so any split of the sound gives the same integers.
class Quantiser {
 public:
  Quantiser(int bits, int channels, std::uint64_t seed)
      : bits_(bits), channels_(static_cast<std::uint32_t>(channels)), seed_(seed) {}

  /// Integers in the upper `bits` of 32, as libsndfile takes them. 1 is full scale: it becomes the
  /// largest integer, and so does what is beyond, counted.
  void quantise(std::span<const float> interleaved, std::span<std::int32_t> out);

  std::int64_t clipped() const { return clipped_; }

 private:
  int bits_;
  std::uint32_t channels_;
  std::uint64_t seed_;
  std::uint64_t frame_ = 0;  ///< of the next sample
  std::uint32_t channel_ = 0;
  std::int64_t clipped_ = 0;
};

}  // namespace knotwave::io
