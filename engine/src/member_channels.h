// SPDX-License-Identifier: MIT
// Which member channel of an MPE lower zone a note goes out on: of those that are free the one that
// has been so longest, so that what still fades on a channel is left alone as long as may be.
// Source: MIDI Polyphonic Expression 1.0 (M1-100-UM), A.3. All [audio].
#pragma once
#include <array>
#include <cstdint>

#include "knotwave/base/rt.h"

namespace knotwave::engine {

class MemberChannels {
 public:
  static constexpr int kFirst = 2, kLast = 16;

  /// 2..16. `taken` has bit c set for a channel c that a note is on; not all of them may be.
  int oldest_free(std::uint32_t taken) const KNOTWAVE_RT {
    int oldest = 0;
    for (int channel = kFirst; channel <= kLast; ++channel) {
      if ((taken >> channel & 1) != 0) continue;
      if (oldest == 0 || freed(channel) < freed(oldest)) oldest = channel;
    }
    return oldest == 0 ? kFirst : oldest;
  }
  /// The note on `channel` has ended.
  void free(int channel) KNOTWAVE_RT { freed_[static_cast<std::size_t>(channel)] = ++count_; }

 private:
  std::uint64_t freed(int channel) const KNOTWAVE_RT {
    return freed_[static_cast<std::size_t>(channel)];
  }
  std::array<std::uint64_t, kLast + 1> freed_{};
  std::uint64_t count_ = 0;
};

}  // namespace knotwave::engine
