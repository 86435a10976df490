// SPDX-License-Identifier: MIT
// Hands immutable objects from the control thread to the audio thread and takes them back: two
// rings and credits, so neither ring can overflow and nothing is freed on the audio thread.
#pragma once
#include <memory>

#include "knotwave/base/spsc_ring.h"

namespace knotwave::base {

/// One publisher [control], one reader [audio].
template <class T>
class HandOver {
 public:
  /// At most `credits` objects may be out (published and not yet returned) at a time. [control]
  explicit HandOver(std::size_t credits = 32)
      : credits_(credits), forward_(credits + 1), back_(credits + 1) {}
  ~HandOver() {
    collect();
    T* object = nullptr;
    while (forward_.pop(object)) delete object;
  }
  HandOver(const HandOver&) = delete;
  HandOver& operator=(const HandOver&) = delete;

  /// Gives the object away; true when it is on its way. With no credit left it is kept as pending
  /// and a newer one replaces it; false then. [control]
  bool publish(std::unique_ptr<T> object) {
    collect();
    pending_ = std::move(object);
    return flush();
  }

  /// Frees what came back and sends what was pending. Call it now and then. [control]
  void collect() {
    T* object = nullptr;
    while (back_.pop(object)) {
      delete object;
      --out_;
    }
    flush();
  }

  /// Objects published and not yet freed. [control]
  std::size_t objects_out() const noexcept { return out_; }

  /// The next object, or null. The audio side owns it until release(). [audio]
  T* acquire() KNOTWAVE_RT {
    T* object = nullptr;
    return forward_.pop(object) ? object : nullptr;
  }

  /// Sends an object back to be freed on the control thread. Cannot fail: credits bound it. [audio]
  void release(T* object) KNOTWAVE_RT {
    const bool sent = back_.push(object);
    KNOTWAVE_ASSERT(sent);
    static_cast<void>(sent);
  }

 private:
  bool flush() {
    if (!pending_ || out_ >= credits_) return false;
    T* raw = pending_.release();
    ++out_;
    const bool sent = forward_.push(raw);
    KNOTWAVE_ASSERT(sent);
    return sent;
  }

  std::size_t credits_;
  std::size_t out_ = 0;
  std::unique_ptr<T> pending_;
  SpscRing<T*> forward_;
  SpscRing<T*> back_;
};

}  // namespace knotwave::base
