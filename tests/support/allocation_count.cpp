// SPDX-License-Identifier: MIT
#include "support/allocation_count.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

thread_local std::int64_t count = 0;
std::atomic<std::int64_t> living{0};

void* counted(void* memory) {
  ++count;
  if (memory != nullptr) living.fetch_add(1, std::memory_order_relaxed);
  return memory;
}

void* allocated(std::size_t size, std::size_t alignment) {
  const std::size_t whole = (size + alignment - 1) / alignment * alignment;
  void* memory = counted(alignment <= alignof(std::max_align_t)
                             ? std::malloc(size != 0 ? size : 1)
                             : std::aligned_alloc(alignment, whole != 0 ? whole : alignment));
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void released(void* memory) noexcept {
  if (memory != nullptr) living.fetch_sub(1, std::memory_order_relaxed);
  std::free(memory);
}

}  // namespace

namespace knotwave::support {
std::int64_t allocation_count() noexcept { return count; }
std::int64_t live_objects() noexcept { return living.load(std::memory_order_relaxed); }
}  // namespace knotwave::support

// The array forms of the library call these. The nothrow ones are here as well: a sanitizer has its
// own, whose memory this delete could not free.
void* operator new(std::size_t size) { return allocated(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocated(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return counted(std::malloc(size != 0 ? size : 1));
}
void operator delete(void* memory, const std::nothrow_t& /*tag*/) noexcept { released(memory); }
void operator delete(void* memory) noexcept { released(memory); }
void operator delete(void* memory, std::size_t) noexcept { released(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { released(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { released(memory); }
