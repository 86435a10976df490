// SPDX-License-Identifier: MIT
#include "replay.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <memory>
#include <span>

#include "knotwave/base/sha256.h"
#include "knotwave/engine/live_engine.h"

namespace knotwave::bench {
namespace {

constexpr std::int64_t kStartNs = 5'000'000'000;

[[noreturn]] void give_up(const std::string& why) {
  std::cerr << "worst_case: " << why << "\n";
  std::exit(EXIT_FAILURE);
}

template <class T>
T value_of(Result<T> result) {
  if (!result) give_up(result.error().to_string());
  return std::move(result).value();
}

std::int64_t time_of(std::int64_t frame) {
  return kStartNs +
         static_cast<std::int64_t>(std::floor(static_cast<double>(frame) * 1e9 / kRateHz + 0.5));
}

/// One performance of a script.
class Performance {
 public:
  Performance(const engine::BankSpec& bank, const Script& script, const Setup& setup)
      : script_(script) {
    engine::LiveConfig config;
    config.engine.rate_hz = kRateHz;
    config.engine.max_voices = setup.max_voices;
    config.engine.threads = setup.threads;
    live_ =
        value_of(engine::LiveEngine::create(config, value_of(engine::BankProgram::create(bank))));
    if (script.swap_block >= 0) next_bank_ = value_of(engine::BankProgram::create(bank));
  }

  /// Nanoseconds the block took.
  std::int64_t block(int number) {
    if (number == script_.swap_block) live_->install(std::move(next_bank_));
    exact_.clear();
    for (; next_ < script_.messages.size() && script_.messages[next_].block == number; ++next_) {
      hear(script_.messages[next_]);
    }
    const std::int64_t time_ns = time_of(std::int64_t{number} * kBlockFrames);
    const auto begin = std::chrono::steady_clock::now();
    live_->process(time_ns, exact_, left_, right_);
    const auto end = std::chrono::steady_clock::now();
    sha256_.update(left_);
    sha256_.update(right_);
    return std::chrono::nanoseconds(end - begin).count();
  }

  engine::LiveStatus status() { return live_->status(); }
  std::string finish_hex() { return sha256_.finish_hex(); }

 private:
  void hear(const Played& played) {
    base::MidiEvent event;
    std::copy(played.bytes.begin(), played.bytes.end(), event.bytes);
    if (script_.through_ring) {
      const std::int64_t frame = std::int64_t{played.block} * kBlockFrames + played.offset;
      if (!live_->push(0, engine::live_message(event, time_of(frame - kBlockFrames)))) {
        give_up("a ring is too short for the script");
      }
      return;
    }
    event.time.sample = played.offset;
    exact_.push_back({.midi = event});
  }

  const Script& script_;
  std::unique_ptr<engine::LiveEngine> live_;
  std::unique_ptr<const engine::BankProgram> next_bank_;
  std::size_t next_ = 0;
  std::vector<engine::Event> exact_;
  std::array<float, kBlockFrames> left_{}, right_{};
  base::Sha256 sha256_;
};

}  // namespace

Replay replay(const engine::BankSpec& bank, const Script& script, const Setup& setup) {
  Replay out;
  const auto blocks = static_cast<std::size_t>(script.blocks);
  out.us.assign(blocks, std::numeric_limits<double>::infinity());
  out.voices.assign(blocks, 0);
  for (int turn = 0; turn < setup.replays; ++turn) {
    Performance performance(bank, script, setup);
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::int64_t ns = performance.block(static_cast<int>(b));
      out.us[b] = std::min(out.us[b], static_cast<double>(ns) * 1e-3);
      const engine::EngineCounters counters = performance.status().counters;
      out.voices[b] = counters.voices_now;
      out.dropped = counters.notes_dropped;
    }
    const std::string sha256 = performance.finish_hex();
    if (turn > 0 && sha256 != out.sha256) give_up("two replays of one script differ");
    out.sha256 = sha256;
  }
  return out;
}

double percentile(std::vector<double> values, double p) {
  const double last = static_cast<double>(values.size()) - 1;
  const auto rank = static_cast<std::size_t>(
      std::clamp(std::ceil(p / 100 * static_cast<double>(values.size())) - 1, 0.0, last));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace knotwave::bench
