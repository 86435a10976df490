// SPDX-License-Identifier: MIT
// Blocks to pieces, and events to the samples they are heard at.
#include "knotwave/engine/engine.h"

#include <algorithm>

#include "knotwave/base/document.h"
#include "knotwave/base/fp_state.h"

#include "performance.h"
#include "piece.h"
#include "workers.h"

namespace knotwave::engine {
namespace {

Result<void> check(const EngineConfig& config) {
  const auto outside = [](const char* what, double value, double low, double high) {
    return fail(ErrorCode::value_out_of_range,
                std::string(what) + " is " + base::number_text(value) + "; it must be in " +
                    base::number_text(low) + " to " + base::number_text(high));
  };
  if (!(config.rate_hz >= 8000 && config.rate_hz <= 768000))
    return outside("the sample rate", config.rate_hz, 8000, 768000);
  if (config.max_voices < 1 || config.max_voices > 4096)
    return outside("the number of voices", config.max_voices, 1, 4096);
  if (config.threads < 1 || config.threads > 64)
    return outside("the number of threads", config.threads, 1, 64);
  if (!(config.volume_db >= -200 && config.volume_db <= 60))
    return outside("the master volume in dB", config.volume_db, -200, 60);
  return {};
}

}  // namespace

struct Engine::State {
  explicit State(const EngineConfig& engine_config)
      : config(engine_config), performance(engine_config), piece(engine_config, performance) {}

  void reset(const BankProgram* bank) {
    performance.reset(bank);
    piece.reset();
  }

  void play(const Event& event) KNOTWAVE_RT;

  const EngineConfig config;
  const BankProgram* first_bank = nullptr;
  Performance performance;
  Piece piece;
};

Engine::Engine(std::unique_ptr<State> state) : state_(std::move(state)) {}
Engine::~Engine() = default;

Result<std::unique_ptr<Engine>> Engine::create(const EngineConfig& config,
                                               const BankProgram* bank) {
  if (auto ok = check(config); !ok) return ok.error();
  if (bank == nullptr) return fail(ErrorCode::missing_key, "the engine needs a bank");
  auto state = std::make_unique<State>(config);
  if (config.threads > 1) {
    auto workers = Workers::start(config.threads);
    if (!workers) return std::move(workers).error();
    state->piece.set_workers(std::move(workers).value());
  }
  state->first_bank = bank;
  state->reset(bank);
  return std::unique_ptr<Engine>(new Engine(std::move(state)));
}

void Engine::reset() { state_->reset(state_->first_bank); }

std::int64_t Engine::now() const KNOTWAVE_RT { return state_->piece.now(); }

const EngineCounters& Engine::counters() const KNOTWAVE_RT {
  return state_->performance.counters();
}

bool Engine::is_idle() const KNOTWAVE_RT {
  const auto slots = state_->performance.slots().all();
  return std::all_of(slots.begin(), slots.end(),
                     [](const VoiceSlot& slot) { return slot.state == VoiceSlot::State::free; });
}

bool Engine::is_playing(const BankProgram* bank) const KNOTWAVE_RT {
  return state_->performance.bank() == bank || state_->performance.slots().is_playing(bank);
}

std::span<const EndedNote> Engine::ended_notes() const KNOTWAVE_RT {
  return state_->performance.ended_notes();
}

Engine::Newest Engine::newest() const KNOTWAVE_RT {
  return state_->performance.newest(state_->piece.now());
}

void Engine::process(std::span<const Event> events, std::span<float> left,
                     std::span<float> right) KNOTWAVE_RT {
  process(events, left, right, {});
}

void Engine::process(std::span<const Event> events, std::span<float> left, std::span<float> right,
                     std::span<const Stem> stems) KNOTWAVE_RT {
  const base::FpStateGuard fp_state;
  State& s = *state_;
  Piece& piece = s.piece;
  s.performance.forget_ended_notes();
  const std::size_t frames = std::min(left.size(), right.size());
  const std::int64_t begin = piece.now(), end = begin + static_cast<std::int64_t>(frames);
  const auto close = [&] {
    const auto at = static_cast<std::size_t>(piece.first() - begin);
    const auto n = static_cast<std::size_t>(piece.now() - piece.first());
    piece.close(left.subspan(at, n), right.subspan(at, n), stems, at);
  };
  std::size_t next = 0;
  for (;;) {
    const bool is_over = piece.now() == end && frames > 0;
    if (!is_over && s.performance.next_group() <= piece.now()) piece.carry_group_over();
    while (next < events.size() && base::first_sample(events[next].time()) <= piece.now()) {
      s.play(events[next++]);
    }
    if (piece.now() == end) break;
    std::int64_t until = std::min(end, s.performance.next_group());
    if (next < events.size()) until = std::min(until, base::first_sample(events[next].time()));
    piece.extend(std::min(static_cast<std::size_t>(until - piece.now()), piece.room()));
    if (piece.now() == end || piece.room() == 0) close();
  }
  while (next < events.size()) s.play(events[next++]);  // past the end, against the contract
}

void Engine::State::play(const Event& event) KNOTWAVE_RT {
  base::SampleTime time = event.time();
  if (base::first_sample(time) != piece.now()) {  // early ones are played too: none may be lost
    ++performance.counters().events_late;
    time = {piece.now(), 0};
  }
  piece.play(event, time);
}

}  // namespace knotwave::engine
