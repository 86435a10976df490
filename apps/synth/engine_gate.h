// SPDX-License-Identifier: MIT
// The engine that messages of many threads go to, while the control thread may exchange it.
#pragma once
#include <atomic>
#include <thread>

#include "knotwave/engine/live_engine.h"

namespace knotwave::synth {

/// Inputs of the engine besides the MIDI ports 0..15.
inline constexpr int kKeyboardInput = 16, kNetworkInput = 17, kControlInput = 18;

class EngineGate {
 public:
  /// As LiveEngine::push(); false while there is no engine. [any]
  bool push(int input, const engine::LiveMessage& message) noexcept {
    pushing_.fetch_add(1);
    engine::LiveEngine* engine = engine_.load();
    const bool is_taken = engine != nullptr && engine->push(input, message);
    pushing_.fetch_sub(1);
    return is_taken;
  }
  /// Nobody pushes into the old engine once this returns. [control]
  void lead_to(engine::LiveEngine* engine) noexcept {
    engine_.store(engine);
    while (pushing_.load() != 0) std::this_thread::yield();
  }

 private:
  std::atomic<engine::LiveEngine*> engine_{nullptr};
  std::atomic<int> pushing_{0};
};

}  // namespace knotwave::synth
