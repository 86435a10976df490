// SPDX-License-Identifier: MIT
// A sound device that is only simulated, and a journal played again.
#pragma once
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/engine/live_engine.h"

#include "scenes.h"

namespace knotwave::engine::scenes {

inline constexpr double kRateHz = 48000;

inline std::unique_ptr<LiveEngine> live_for(std::unique_ptr<const BankProgram> bank,
                                            LiveConfig config = {}, JournalBank source = {}) {
  auto made = LiveEngine::create(config, std::move(bank), std::move(source));
  EXPECT_TRUE(made) << (made ? "" : made.error().to_string());
  return made ? *std::move(made) : nullptr;
}

inline LiveMessage message(std::int64_t time_ns, int status, int one, int two) {
  LiveMessage out;
  out.time_ns = time_ns;
  out.bytes[0] = static_cast<std::uint8_t>(status);
  out.bytes[1] = static_cast<std::uint8_t>(one);
  out.bytes[2] = static_cast<std::uint8_t>(two);
  return out;
}

/// Asks for blocks at the times an exact clock says, and keeps what it is given.
class Device {
 public:
  explicit Device(LiveEngine& live, std::int64_t start_ns = 5'000'000'000)
      : live_(live), start_ns_(start_ns) {}

  std::int64_t frames() const { return static_cast<std::int64_t>(sound_.left.size()); }
  std::int64_t time_of(double frame) const {
    return start_ns_ + static_cast<std::int64_t>(std::floor(frame * 1e9 / kRateHz + 0.5));
  }
  /// When the next block is asked for.
  std::int64_t time_ns() const { return time_of(static_cast<double>(frames())); }
  const Sound& sound() const { return sound_; }

  void block(std::size_t frames, std::int64_t jitter_ns = 0,
             std::span<const base::MidiEvent> exact = {}) {
    std::vector<Event> events(exact.size());
    for (std::size_t i = 0; i < exact.size(); ++i) events[i].midi = exact[i];
    block_with(frames, jitter_ns, events);
  }
  void block_with(std::size_t frames, std::int64_t jitter_ns, std::span<const Event> exact) {
    const std::int64_t time = time_ns() + jitter_ns;
    const std::size_t at = sound_.left.size();
    sound_.left.resize(at + frames, 9.0F);
    sound_.right.resize(at + frames, 9.0F);
    live_.process(time, exact, std::span(sound_.left).subspan(at),
                  std::span(sound_.right).subspan(at));
  }
  void blocks(int count, std::size_t frames) {
    for (int i = 0; i < count; ++i) block(frames);
  }

 private:
  LiveEngine& live_;
  std::int64_t start_ns_;
  Sound sound_;
};

/// `bank_of_index` compiles the one of Journal::banks with that index.
template <class BankOfIndex>
Sound played_again(const Journal& journal, BankOfIndex&& bank_of_index, std::size_t frames,
                   std::size_t block = 333) {
  std::vector<std::unique_ptr<const BankProgram>> banks;
  banks.push_back(bank_of_index(0));
  std::vector<Event> events = journal_events(journal);
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (events[i].kind != Event::Kind::install_bank) continue;
    banks.push_back(bank_of_index(journal.records[i].index));
    events[i].bank = banks.back().get();
  }
  const auto engine = engine_for(*banks[0], {.rate_hz = journal.rate_hz,
                                             .max_voices = journal.max_voices,
                                             .seed = journal.seed,
                                             .volume_db = journal.volume_db});
  const Sound sound = play(*engine, events, frames, block);
  EXPECT_EQ(engine->counters().events_late, 0);
  return sound;
}

inline Journal journal_of(LiveEngine& live) {
  Journal journal;
  live.take_journal(journal);
  return journal;
}

}  // namespace knotwave::engine::scenes
