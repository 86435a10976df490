// SPDX-License-Identifier: MIT
// A host's two threads around a plugin: one plays blocks while the other loads one thing after the
// other; and the random messages that it plays.
#pragma once
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>

#include "knotwave/engine/event.h"

#include "rt_gate.h"

namespace knotwave::rt {

constexpr int kBlocksOfALoad = 24;
constexpr int kMostBlocks = 200'000;

/// Loads 0..count-1, each kept for kBlocksOfALoad blocks at least.
class LoadingThread {
 public:
  struct Work {
    int count = 0;
    std::function<void(int)> load;
    std::function<void()> collect;
  };
  explicit LoadingThread(const Work& work) : thread_([this, work] { run(work); }) {}
  ~LoadingThread() { thread_.join(); }
  LoadingThread(const LoadingThread&) = delete;
  LoadingThread& operator=(const LoadingThread&) = delete;

  /// Plays until all was loaded and the storm has had enough: a busy machine makes it longer, never
  /// shorter.
  template <class Storm>
  void play(Storm& storm) {
    while (blocks_.load() < kMostBlocks && !(is_done_.load() && storm.has_enough())) {
      storm.block();
      blocks_.fetch_add(1);
    }
  }
  int blocks() const { return blocks_.load(); }

 private:
  void run(const Work& work) {
    for (int i = 0; i < work.count; ++i) {
      const int begin = blocks_.load();
      work.load(i);
      while (blocks_.load() < begin + kBlocksOfALoad && blocks_.load() < kMostBlocks) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      work.collect();
    }
    is_done_ = true;
  }

  std::atomic<int> blocks_{0};
  std::atomic<bool> is_done_{false};
  std::thread thread_;
};

/// Once to touch every page, once more in the gate.
struct StormReport {
  GateReport gate;
  int blocks = 0;
};
template <class Storm>
StormReport storm_in_gate(Gate gate, Storm& storm, const LoadingThread::Work& work) {
  std::unique_ptr<LoadingThread> loading;
  StormReport report;
  report.gate = run_in_gate(
      gate, [&] { loading->play(storm); },
      [&] {
        LoadingThread(work).play(storm);
        loading = std::make_unique<LoadingThread>(work);
      });
  report.blocks = loading->blocks();
  return report;
}

/// Notes for the most part, on 16 channels.
inline engine::Event random_message(std::uint64_t draw, std::int64_t sample) {
  constexpr std::array<std::uint8_t, 8> kStatus = {0x90, 0x90, 0x90, 0x80, 0xB0, 0xC0, 0xD0, 0xE0};
  engine::Event event;
  event.midi.time.sample = sample;
  event.midi.bytes[0] = static_cast<std::uint8_t>(kStatus[draw & 7] | (draw >> 3 & 15));
  event.midi.bytes[1] = static_cast<std::uint8_t>(draw >> 8 & 127);
  event.midi.bytes[2] = static_cast<std::uint8_t>(draw >> 16 & 127);
  return event;
}

}  // namespace knotwave::rt
