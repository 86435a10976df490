// SPDX-License-Identifier: MIT
// A wait-free ring for one producer thread and one consumer thread.
#pragma once
#include <atomic>
#include <cstddef>
#include <memory>
#include <type_traits>

#include "knotwave/base/rt.h"

namespace knotwave::base {

/// Holds up to `capacity` items (rounded up to a power of two) of a trivially copyable type. Memory
/// is given at construction. push() belongs to one thread, pop() to another.
template <class T>
class SpscRing {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// [control]
  explicit SpscRing(std::size_t capacity) {
    std::size_t size = 1;
    while (size < capacity) size *= 2;
    mask_ = size - 1;
    items_ = std::make_unique<T[]>(size);
  }

  std::size_t capacity() const noexcept { return mask_ + 1; }
  /// Items inside: at most so many as the producer sees it, at least so many as the consumer does.
  /// [audio] or [control], the producer or the consumer.
  std::size_t size() const KNOTWAVE_RT {
    return head_.load(std::memory_order_acquire) - tail_.load(std::memory_order_acquire);
  }

  /// False when full; the item is then not taken. [audio] or [control], one producer.
  bool push(const T& item) KNOTWAVE_RT {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) > mask_) return false;
    items_[head & mask_] = item;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  /// False when empty. [audio] or [control], one consumer.
  bool pop(T& item) KNOTWAVE_RT {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return false;
    item = items_[tail & mask_];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

 private:
  std::unique_ptr<T[]> items_;
  std::size_t mask_ = 0;
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
};

}  // namespace knotwave::base
