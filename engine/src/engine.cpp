// SPDX-License-Identifier: MIT
// Blocks to segments: a segment ends where an event is heard, so that nothing depends on the block.
#include "knotwave/engine/engine.h"

#include <algorithm>
#include <array>

#include "knotwave/base/document.h"
#include "knotwave/base/elementary.h"
#include "knotwave/base/fp_state.h"

#include "channel_bus.h"
#include "performance.h"
#include "workers.h"

namespace knotwave::engine {
namespace {

/// The longest run of samples between two looks at the voices.
constexpr std::size_t kSegment = 256;
/// Fewer samples than this over all voices are not worth a wake.
constexpr std::size_t kSamplesWorthAWake = 1024;

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
      : config(engine_config),
        volume_lin(base::db_to_gain(engine_config.volume_db)),
        performance(engine_config),
        scratches(static_cast<std::size_t>(engine_config.threads)),
        voice_left(performance.slots().all().size() * kSegment),
        voice_right(voice_left.size()) {
    active.reserve(performance.slots().all().size());
    for (ChannelBus& bus : buses) bus.prepare(config.rate_hz, kSegment);
  }

  void reset(const BankProgram* bank) {
    performance.reset(bank);
    now = 0;
    for (int c = 0; c < kChannels; ++c) {
      buses[static_cast<std::size_t>(c)].reset(performance.channel(c), volume_lin);
    }
  }

  void play(const Event& event) KNOTWAVE_RT;
  void render_segment(std::size_t n) KNOTWAVE_RT;
  void render_share(int thread) KNOTWAVE_RT;
  void mix(std::size_t n, std::span<float> left, std::span<float> right,
           std::span<const Stem> stems, std::size_t offset) KNOTWAVE_RT;
  std::span<float> side_of(std::vector<float>& side, int voice) KNOTWAVE_RT {
    return std::span(side).subspan(static_cast<std::size_t>(voice) * kSegment, segment);
  }

  const EngineConfig config;
  const double volume_lin;
  const BankProgram* first_bank = nullptr;
  Performance performance;
  std::array<ChannelBus, kChannels> buses;
  std::array<bool, kChannels> bus_sounds{};
  std::vector<VoiceScratch> scratches;
  std::vector<float> voice_left, voice_right;  ///< [voices][kSegment]
  std::vector<int> active;
  std::size_t segment = 0;
  int sharing = 1;  ///< threads that take part in this segment
  std::int64_t now = 0;
  std::unique_ptr<Workers> workers;  ///< none: one thread renders all
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
    state->workers = std::move(workers).value();
  }
  state->first_bank = bank;
  state->reset(bank);
  return std::unique_ptr<Engine>(new Engine(std::move(state)));
}

void Engine::reset() { state_->reset(state_->first_bank); }

std::int64_t Engine::now() const KNOTWAVE_RT { return state_->now; }

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

Engine::Newest Engine::newest() const KNOTWAVE_RT {
  return state_->performance.newest(state_->now);
}

void Engine::process(std::span<const Event> events, std::span<float> left,
                     std::span<float> right) KNOTWAVE_RT {
  process(events, left, right, {});
}

void Engine::process(std::span<const Event> events, std::span<float> left, std::span<float> right,
                     std::span<const Stem> stems) KNOTWAVE_RT {
  const base::FpStateGuard fp_state;
  State& s = *state_;
  const std::size_t frames = std::min(left.size(), right.size());
  const std::int64_t end = s.now + static_cast<std::int64_t>(frames);
  std::size_t next = 0, at = 0;
  for (;;) {
    while (next < events.size() && base::first_sample(events[next].time()) <= s.now) {
      s.play(events[next++]);
    }
    if (at == frames) break;
    std::int64_t until = end;
    if (next < events.size()) until = std::min(until, base::first_sample(events[next].time()));
    const std::size_t n = std::min(static_cast<std::size_t>(until - s.now), kSegment);
    s.render_segment(n);
    s.mix(n, left, right, stems, at);
    s.now += static_cast<std::int64_t>(n);
    at += n;
    s.performance.collect();
  }
  while (next < events.size()) s.play(events[next++]);  // past the end, against the contract
}

void Engine::State::play(const Event& event) KNOTWAVE_RT {
  base::SampleTime time = event.time();
  if (base::first_sample(time) != now) {  // early ones are played too: none may be lost
    ++performance.counters().events_late;
    time = {now, 0};
  }
  performance.handle(event, time);
  const bool may_move_a_bus =
      event.kind == Event::Kind::midi && (event.midi.status() == base::MidiStatus::control_change ||
                                          event.midi.status() == base::MidiStatus::system);
  if (!may_move_a_bus) return;
  for (int c = 0; c < kChannels; ++c) {
    buses[static_cast<std::size_t>(c)].follow(performance.channel(c),
                                              volume_lin * performance.master_gain(), now,
                                              performance.slots().bus_is_silent(c));
  }
}

void Engine::State::render_segment(std::size_t n) KNOTWAVE_RT {
  segment = n;
  active.clear();
  const auto slots = performance.slots().all();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i].state != VoiceSlot::State::free) active.push_back(static_cast<int>(i));
  }
  sharing = 1;
  if (workers && active.size() > 1 && active.size() * n >= kSamplesWorthAWake) {
    sharing = workers->threads();
    workers->run([](void* self, int thread) { static_cast<State*>(self)->render_share(thread); },
                 this);
  } else {
    render_share(0);
  }
}

void Engine::State::render_share(int thread) KNOTWAVE_RT {
  VoiceScratch& scratch = scratches[static_cast<std::size_t>(thread)];
  for (auto i = static_cast<std::size_t>(thread); i < active.size();
       i += static_cast<std::size_t>(sharing)) {
    performance.voice(active[i]).render(now, performance.tempo(), scratch,
                                        side_of(voice_left, active[i]),
                                        side_of(voice_right, active[i]));
  }
}

void Engine::State::mix(std::size_t n, std::span<float> left, std::span<float> right,
                        std::span<const Stem> stems, std::size_t offset) KNOTWAVE_RT {
  bus_sounds.fill(false);
  for (const int voice : active) {
    const auto bus = static_cast<std::size_t>(performance.slots().at(voice).bus);
    if (!bus_sounds[bus]) buses[bus].clear(n);
    bus_sounds[bus] = true;
    buses[bus].add(side_of(voice_left, voice), side_of(voice_right, voice));
  }
  const std::span<float> out_left = left.subspan(offset, n), out_right = right.subspan(offset, n);
  std::fill(out_left.begin(), out_left.end(), 0.0F);
  std::fill(out_right.begin(), out_right.end(), 0.0F);
  for (std::size_t c = 0; c < kChannels; ++c) {
    ChannelBus::Sides sides;
    if (bus_sounds[c]) sides = buses[c].finish(now, n);
    for (std::size_t i = 0; i < sides.left.size(); ++i) {
      out_left[i] += sides.left[i];
      out_right[i] += sides.right[i];
    }
    if (c >= stems.size()) continue;
    const auto stem_left = stems[c].left.subspan(offset, n);
    const auto stem_right = stems[c].right.subspan(offset, n);
    if (bus_sounds[c]) {
      std::copy(sides.left.begin(), sides.left.end(), stem_left.begin());
      std::copy(sides.right.begin(), sides.right.end(), stem_right.begin());
    } else {
      std::fill(stem_left.begin(), stem_left.end(), 0.0F);
      std::fill(stem_right.begin(), stem_right.end(), 0.0F);
    }
  }
}

}  // namespace knotwave::engine
