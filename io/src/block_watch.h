// SPDX-License-Identifier: MIT
// Notices that no block comes any more.
#pragma once
#include <algorithm>
#include <cstdint>

namespace knotwave::io {

/// [control]
class BlockWatch {
 public:
  static constexpr std::int64_t kLimitNs = 800'000'000;

  void restart(std::int64_t now_ns) noexcept { moved_ns_ = now_ns; }
  /// `blocks` so far, each of which lasts `length_ns`. True when none has come for 0.8 s, or for
  /// four of them where that is longer.
  bool is_silent(std::int64_t blocks, std::int64_t length_ns, std::int64_t now_ns) noexcept {
    if (blocks != blocks_) {
      blocks_ = blocks;
      moved_ns_ = now_ns;
    }
    return now_ns - moved_ns_ >= std::max(kLimitNs, 4 * length_ns);
  }

 private:
  std::int64_t blocks_ = 0, moved_ns_ = 0;
};

}  // namespace knotwave::io
