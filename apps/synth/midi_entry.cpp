// SPDX-License-Identifier: MIT
#include "midi_entry.h"

#include <algorithm>
#include <utility>

namespace knotwave::synth {
namespace {

constexpr double kClockRate = 48000;  ///< clocks are counted in these, whatever the device's rate

/// Nanoseconds as samples of kClockRate with their fraction: 6 samples are 125 us.
base::SampleTime clock_time(std::int64_t time_ns) {
  const std::int64_t periods = time_ns / 125000, rest_ns = time_ns % 125000;
  const auto scaled = static_cast<std::uint64_t>(rest_ns) * 6;
  base::SampleTime time;
  time.sample = periods * 6 + static_cast<std::int64_t>(scaled / 125000);
  time.fraction = static_cast<std::uint32_t>((scaled % 125000 << 32) / 125000);
  return time;
}

}  // namespace

MidiEntry::MidiEntry(EngineGate& gate) : gate_(gate) {
  lock_.clear();
  exact_.reserve(2 * kMostExact + PortNotes::kMostHeld);
  for (engine::MidiClock& clock : clocks_) clock.reset(kClockRate);
}

engine::MidiLearn::Out MidiEntry::learned(const base::MidiEvent& event) noexcept {
  if (has_learn_.load(std::memory_order_relaxed)) {
    const Lock lock(lock_, kTries);
    if (lock.is_held() && learn_) return learn_->translate(event);
  }
  engine::MidiLearn::Out out;
  out.messages[0] = event;
  out.count = 1;
  return out;
}

/// Whether bit `port` was set; it is no more.
bool MidiEntry::take_bit(std::atomic<std::uint32_t>& bits, std::size_t port) noexcept {
  const std::uint32_t bit = std::uint32_t{1} << port;
  if ((bits.load(std::memory_order_relaxed) & bit) == 0) return false;
  bits.fetch_and(~bit, std::memory_order_relaxed);
  return true;
}

std::optional<engine::MidiClock::News> MidiEntry::follow_clock(const base::MidiEvent& event,
                                                               std::int64_t time_ns,
                                                               std::size_t port) noexcept {
  const std::uint8_t status = event.bytes[0];
  const bool is_transport = status >= 0xFA && status <= 0xFC;
  if (status != 0xF8 && status != 0xF2 && !is_transport) return std::nullopt;
  base::MidiEvent timed = event;
  timed.time = clock_time(time_ns);
  if (take_bit(must_tell_, port)) clocks_[port].tell_again();
  const engine::MidiClock::News news = clocks_[port].handle(timed);
  const engine::MidiClockStatus now = clocks_[port].status();
  bpm_.store(static_cast<float>(now.bpm), std::memory_order_relaxed);
  jitter_ms_.store(static_cast<float>(now.jitter_ms), std::memory_order_relaxed);
  return news;
}

PortNotes& MidiEntry::notes_of(std::size_t port) noexcept {
  if (take_bit(must_forget_, port)) notes_[port] = {};
  return notes_[port];
}

void MidiEntry::heard(const base::MidiEvent& event, std::int64_t time_ns) noexcept {
  const std::size_t port = event.port % kStreamPort;
  if ((left_out_.load(std::memory_order_relaxed) >> port & 1) != 0) return;
  const auto push = [&](const engine::LiveMessage& message) {
    gate_.push(static_cast<int>(port), message);
  };
  // Clocks are no music: what they tell is handed on in their place.
  if (const auto news = follow_clock(event, time_ns, port)) {
    engine::LiveMessage told;
    told.time_ns = time_ns;
    if (news->tempo) {
      told.kind = engine::LiveMessage::Kind::tempo;
      told.number = clocks_[port].tempo_event().microseconds_per_quarter;
      push(told);
    }
    if (news->position) {
      told.kind = engine::LiveMessage::Kind::position;
      told.number = static_cast<double>(clocks_[port].position_event().song_clocks);
      push(told);
    }
    return;
  }
  notes_of(port).heard(event);
  const auto out = learned(event);
  for (int i = 0; i < out.count; ++i) {
    push(engine::live_message(out.messages[static_cast<std::size_t>(i)], time_ns));
  }
}

void MidiEntry::lost(int port) noexcept {
  const std::size_t index = static_cast<std::size_t>(port) % kStreamPort;
  notes_of(index).release([&](std::uint8_t status, std::uint8_t first, std::uint8_t second) {
    engine::LiveMessage message;
    message.bytes[0] = status;
    message.bytes[1] = first;
    message.bytes[2] = second;
    gate_.push(static_cast<int>(index), message);
  });
}

void MidiEntry::follow_stream_sender() noexcept {
  if (!has_sender_left_.exchange(false, std::memory_order_relaxed)) return;
  notes_of(kStreamPort)
      .release([this](std::uint8_t status, std::uint8_t first, std::uint8_t second) {
        exact_.push_back({.midi = {{0, 0}, {status, first, second}}});
      });
}

std::span<const engine::Event> MidiEntry::translated(std::span<const base::MidiEvent> exact,
                                                     std::int64_t time_ns,
                                                     double rate_hz) KNOTWAVE_RT {
  exact_.clear();
  follow_stream_sender();
  const auto add = [this](engine::Event event, base::SampleTime time) {
    event.midi.time = time;
    exact_.push_back(event);
  };
  for (const base::MidiEvent& event : exact.first(std::min(exact.size(), kMostExact))) {
    const auto offset_ns =
        static_cast<std::int64_t>(static_cast<double>(event.time.sample) * 1e9 / rate_hz);
    if (const auto news = follow_clock(event, time_ns + offset_ns, kStreamPort)) {
      if (news->tempo) add(clocks_[kStreamPort].tempo_event(), event.time);
      if (news->position) add(clocks_[kStreamPort].position_event(), event.time);
      continue;
    }
    notes_of(kStreamPort).heard(event);
    const auto out = learned(event);
    for (int i = 0; i < out.count; ++i) {
      add({.midi = out.messages[static_cast<std::size_t>(i)]}, event.time);
    }
  }
  return exact_;
}

void MidiEntry::forget() noexcept {
  must_forget_ = kEveryPort;
  const Lock lock(lock_, kEndless);
  if (learn_) learn_->controllers_went_back();
}

void MidiEntry::use(engine::MidiLearn learn) {
  const Lock lock(lock_, kEndless);
  learn_ = std::move(learn);
  has_learn_ = true;
}

bool MidiEntry::learn(int controller) {
  const Lock lock(lock_, kEndless);
  return learn_ && learn_->learn(controller);
}

void MidiEntry::cancel() {
  const Lock lock(lock_, kEndless);
  if (learn_) learn_->cancel();
}

bool MidiEntry::is_learning() {
  const Lock lock(lock_, kEndless);
  return learn_ && learn_->is_learning();
}

std::vector<std::string> MidiEntry::to_turn() {
  using PickUp = engine::MidiLearn::PickUp;
  std::vector<std::pair<int, PickUp>> knobs;
  {
    const Lock lock(lock_, kEndless);
    for (int i = 0; learn_ && i < learn_->size(); ++i) {
      const auto& knob = learn_->knob(i);
      if (knob.pick_up == PickUp::unknown || knob.pick_up == PickUp::held) continue;
      knobs.emplace_back(knob.learned.from, knob.pick_up);
    }
  }
  std::vector<std::string> lines;
  lines.reserve(knobs.size());
  for (const auto& [controller, pick_up] : knobs) {
    lines.push_back("controller " + std::to_string(controller) + ": turn it " +
                    (pick_up == PickUp::too_low ? "up" : "down"));
  }
  return lines;
}

std::optional<engine::LearnSpec> MidiEntry::news() {
  const Lock lock(lock_, kEndless);
  if (!learn_ || !learn_->has_changed()) return std::nullopt;
  return learn_->spec();
}

}  // namespace knotwave::synth
