// SPDX-License-Identifier: MIT
// The live engine's inside: what the control thread and the audio thread share, and what each has
// to itself.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "knotwave/base/hand_over.h"
#include "knotwave/base/latest_value.h"
#include "knotwave/base/spsc_ring.h"
#include "knotwave/engine/live_engine.h"

#include "live_clock.h"
#include "live_input.h"
#include "live_output.h"

namespace knotwave::engine {

/// Events the engine is given in one call; more are given in several.
inline constexpr std::size_t kEventsAtOnce = 1024;

/// A bank with its number, counted from 0 as they were installed.
struct LiveBank {
  std::unique_ptr<const BankProgram> program;
  std::uint32_t number = 0;
};

struct LiveEngine::State {
  explicit State(const LiveConfig& live_config);
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  // live_block.cpp, all [audio].
  void process(std::int64_t time_ns, std::span<const Event> exact, std::span<float> left,
               std::span<float> right) KNOTWAVE_RT;
  void take_bank() KNOTWAVE_RT;
  void return_banks() KNOTWAVE_RT;
  void add_panic() KNOTWAVE_RT;
  base::SampleTime time_of(const Event& exact, std::int64_t first,
                           std::int64_t end) const KNOTWAVE_RT;
  std::int64_t gather(std::span<const Event>& exact, std::int64_t first,
                      std::int64_t end) KNOTWAVE_RT;
  int next_input() const KNOTWAVE_RT;
  Event& add_event(base::SampleTime time) KNOTWAVE_RT;
  void add_message(const PlacedMessage& placed) KNOTWAVE_RT;
  void add_exact(const Event& exact, base::SampleTime at) KNOTWAVE_RT;
  void record(const Event& event) KNOTWAVE_RT;
  void publish_status() KNOTWAVE_RT;

  // Both threads.
  const LiveConfig config;
  std::array<std::unique_ptr<LiveInput>, kLiveInputs> inputs;
  std::atomic<bool> panic{false};
  base::HandOver<const LiveBank> banks;
  LivePeak peak_left, peak_right;
  LiveFade fade;
  base::LatestValue<LiveStatus> published;

  // The audio thread.
  LiveClock clock;
  std::unique_ptr<Engine> engine;
  const LiveBank* playing = nullptr;
  std::array<const LiveBank*, 32> outgoing{};  ///< replaced, still sounding
  int outgoing_count = 0;
  base::SpscRing<JournalRecord> journal;
  LiveTap tap;
  std::vector<Event> events;  ///< [kEventsAtOnce], and so is sysex
  std::vector<std::array<std::uint8_t, LiveMessage::kMaxSysex>> sysex;
  std::size_t event_count = 0;
  std::vector<EndedNote> ended;  ///< of the block
  std::size_t ended_count = 0;
  std::int64_t exact_messages = 0;
  LiveStatus status;

  // The control thread.
  std::map<std::uint32_t, JournalBank> sources;  ///< of banks whose install is not journalled yet
  std::uint32_t last_number = 0;
};

}  // namespace knotwave::engine
