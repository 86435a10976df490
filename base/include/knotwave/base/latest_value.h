// SPDX-License-Identifier: MIT
// The newest of what one thread says, whole, for one other thread: three places and one word that
// says which of them was written last.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "knotwave/base/rt.h"

namespace knotwave::base {

/// Wait-free on both sides; values nobody read are overwritten. The reader never sees half of one.
template <class T>
class LatestValue {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// One writer thread. [audio] or [control]
  void publish(const T& value) KNOTWAVE_RT {
    places_[back_].value = value;
    back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kPlace;
  }
  /// The newest that was published, T{} before the first. One reader thread. [audio] or [control]
  const T& read() KNOTWAVE_RT {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) != 0) {
      front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kPlace;
    }
    return places_[front_].value;
  }

 private:
  static constexpr std::uint32_t kPlace = 3, kFresh = 4;
  struct alignas(64) Place {
    T value{};
  };
  std::array<Place, 3> places_{};
  std::uint32_t back_ = 0;   ///< the writer's
  std::uint32_t front_ = 1;  ///< the reader's
  std::atomic<std::uint32_t> middle_{2};
};

}  // namespace knotwave::base
