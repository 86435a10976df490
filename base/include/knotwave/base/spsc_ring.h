// SPDX-License-Identifier: MIT
// A wait-free ring for one producer thread and one consumer thread: one item at a time, or runs of
// them.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>

#include "knotwave/base/rt.h"

namespace knotwave::base {

/// Holds up to `capacity` items (rounded up to a power of two) of a trivially copyable type. Memory
/// is given at construction. push() and write() belong to one thread, pop() and read() to another.
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

  /// Takes the first of `items` for which there is room, and says how many. One producer. [audio]
  std::size_t write(std::span<const T> items) KNOTWAVE_RT {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    const std::size_t room = capacity() - (head - tail_.load(std::memory_order_acquire));
    const std::size_t count = std::min(items.size(), room);
    const std::size_t first = std::min(count, capacity() - (head & mask_));
    std::copy_n(items.begin(), first, items_.get() + (head & mask_));
    std::copy_n(items.begin() + static_cast<std::ptrdiff_t>(first), count - first, items_.get());
    head_.store(head + count, std::memory_order_release);
    return count;
  }

  /// Fills `out` as far as there is something, and says how far. One consumer. [audio]
  std::size_t read(std::span<T> out) KNOTWAVE_RT {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    const std::size_t count = std::min(out.size(), head_.load(std::memory_order_acquire) - tail);
    const std::size_t first = std::min(count, capacity() - (tail & mask_));
    std::copy_n(items_.get() + (tail & mask_), first, out.begin());
    std::copy_n(items_.get(), count - first, out.begin() + static_cast<std::ptrdiff_t>(first));
    tail_.store(tail + count, std::memory_order_release);
    return count;
  }

 private:
  std::unique_ptr<T[]> items_;
  std::size_t mask_ = 0;
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
};

}  // namespace knotwave::base
