// SPDX-License-Identifier: MIT
// How much of its deadline each block takes. One thread writes, any reads.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>

#include "knotwave/base/rt.h"

namespace knotwave::io {

class LoadMeter {
 public:
  struct Figures {
    std::int64_t overruns = 0;
    double load = 0, p99 = 0, max = 0;  ///< shares of the deadline
  };

  /// A block that lasts `length_ns` took `busy_ns`. [audio]
  void count(std::int64_t busy_ns, std::int64_t length_ns) KNOTWAVE_RT;
  /// p99 is the upper edge of its bin, 1 % wide, or the maximum where that is less. [any]
  Figures figures() const noexcept;

 private:
  static constexpr int kBinsPerDeadline = 100;
  static constexpr std::size_t kBins = 4 * kBinsPerDeadline + 1;  ///< the last: all that is longer
  std::array<std::atomic<std::int64_t>, kBins> bins_{};
  std::atomic<std::int64_t> overruns_{0};
  std::atomic<double> load_{0}, max_{0};
};

}  // namespace knotwave::io
