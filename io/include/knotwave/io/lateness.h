// SPDX-License-Identifier: MIT
// How late things were done. One thread writes, any reads.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>

#include "knotwave/base/rt.h"

namespace knotwave::io {

class Lateness {
 public:
  struct Figures {
    std::int64_t count = 0;
    std::int64_t median_ns = 0, p99_ns = 0;  ///< rounded up, by an eighth at most
    std::int64_t max_ns = 0;
  };

  /// What was due `late_ns` ago was done now; what was early was not late. [audio]
  void add(std::int64_t late_ns) KNOTWAVE_RT;
  Figures figures() const KNOTWAVE_RT;  ///< [any]

 private:
  // Below 8 ns a bin each; from there 8 bins to a factor of 2, up to 2^40 ns, a quarter of an hour.
  static constexpr std::size_t kBins = std::size_t{8} * 38;
  std::array<std::atomic<std::int64_t>, kBins> bins_{};
  std::atomic<std::int64_t> max_ns_{0};
};

}  // namespace knotwave::io
