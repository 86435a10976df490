// SPDX-License-Identifier: MIT
// Clients of a stream for the tests of devices, and what is waited for.
#pragma once
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

#include "knotwave/io/audio_device.h"

namespace knotwave::io {

/// Every sample says which one it is: number i, from 1, of channel c is i / 2^24, negative in odd
/// channels. A float holds it exactly for the first 349 s at 48 kHz.
class NumberedClient : public AudioClient {
 public:
  static float sample(std::int64_t number, std::size_t channel) {
    const float value = static_cast<float>(number) * 0x1p-24F;
    return channel % 2 == 0 ? value : -value;
  }
  static std::int64_t number(float sample) {
    return static_cast<std::int64_t>(std::abs(sample) * 0x1p24F);
  }

  void process(const AudioBlock& block) KNOTWAVE_RT override {
    for (std::size_t c = 0; c < block.outputs.size(); ++c) {
      for (int i = 0; i < block.frames; ++i) block.outputs[c][i] = sample(written_ + 1 + i, c);
    }
    written_ += block.frames;
    overlaps_ += block.frame < next_frame_ ? 1 : 0;
    backsteps_ += block.time_ns < time_ns_ ? 1 : 0;
    next_frame_ = block.frame + block.frames;
    time_ns_ = block.time_ns;
    blocks_.store(blocks_.load() + 1);
  }

  std::int64_t blocks() const { return blocks_; }
  // Of a stream that is stopped:
  std::int64_t written() const { return written_; }
  int overlaps() const { return overlaps_; }    ///< blocks that began before the last one's end
  int backsteps() const { return backsteps_; }  ///< blocks with an earlier time than the last one
  std::int64_t last_time_ns() const { return time_ns_; }

 private:
  std::int64_t written_ = 0, next_frame_ = 0, time_ns_ = 0;
  int overlaps_ = 0, backsteps_ = 0;
  std::atomic<std::int64_t> blocks_{0};
};

/// Seconds until `is_so`, or `timeout_s` if it never is.
inline double seconds_until(const std::function<bool()>& is_so, double timeout_s) {
  const std::int64_t begin_ns = steady_clock_ns();
  const auto passed_s = [&] { return static_cast<double>(steady_clock_ns() - begin_ns) * 1e-9; };
  while (!is_so() && passed_s() < timeout_s) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return passed_s();
}

inline double seconds_taken(const std::function<void()>& work) {
  const std::int64_t begin_ns = steady_clock_ns();
  work();
  return static_cast<double>(steady_clock_ns() - begin_ns) * 1e-9;
}

}  // namespace knotwave::io
