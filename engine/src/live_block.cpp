// SPDX-License-Identifier: MIT
// One block of the live engine: what is due in it, in order, to the engine and into the journal.
#include <algorithm>
#include <cmath>

#include "knotwave/engine/channel_state.h"

#include "live_state.h"

namespace knotwave::engine {
namespace {

constexpr int kChannelCount = 16;
constexpr double kMostMicroseconds = 16777215;
constexpr double kMostSongClocks = 0x1p53;  // every whole number up to it is a double

bool is_before(const PlacedMessage& a, const PlacedMessage& b) KNOTWAVE_RT {
  return a.sample != b.sample ? a.sample < b.sample : a.message.time_ns < b.message.time_ns;
}

}  // namespace

void LiveEngine::State::process(std::int64_t time_ns, std::span<const Event> exact,
                                std::span<float> left, std::span<float> right) KNOTWAVE_RT {
  const std::int64_t first = engine->now();
  const std::int64_t end = first + static_cast<std::int64_t>(left.size());
  clock.begin_block(time_ns, first, left.size());
  for (const auto& input : inputs) input->begin_block(clock, first);
  tap.begin_block();
  event_count = 0;
  ended_count = 0;
  take_bank();
  if (panic.exchange(false, std::memory_order_relaxed)) add_panic();
  while (engine->now() < end) {
    const std::int64_t until = gather(exact, first, end);
    const auto at = static_cast<std::size_t>(engine->now() - first);
    const auto n = static_cast<std::size_t>(until - engine->now());
    engine->process(std::span(events).first(event_count), left.subspan(at, n),
                    right.subspan(at, n));
    for (const EndedNote& note : engine->ended_notes()) {
      if (ended_count < ended.size()) ended[ended_count++] = note;
    }
    event_count = 0;
  }
  tap.write(first, left, right);
  peak_left.add(left);
  peak_right.add(right);
  fade.apply(config.engine.rate_hz, left, right);
  return_banks();
  publish_status();
}

// Of several banks that came, the last is played.
void LiveEngine::State::take_bank() KNOTWAVE_RT {
  const LiveBank* newest = nullptr;
  while (const LiveBank* bank = banks.acquire()) {
    if (newest != nullptr) banks.release(newest);
    newest = bank;
  }
  if (newest == nullptr) return;
  outgoing[static_cast<std::size_t>(outgoing_count++)] = playing;
  playing = newest;
  Event& event = add_event({engine->now(), 0});
  event.kind = Event::Kind::install_bank;
  event.bank = playing->program.get();
  record(event);
}

void LiveEngine::State::return_banks() KNOTWAVE_RT {
  int kept = 0;
  for (int i = 0; i < outgoing_count; ++i) {
    const LiveBank* bank = outgoing[static_cast<std::size_t>(i)];
    if (engine->is_playing(bank->program.get())) {
      outgoing[static_cast<std::size_t>(kept++)] = bank;
    } else {
      banks.release(bank);
    }
  }
  outgoing_count = kept;
}

void LiveEngine::State::add_panic() KNOTWAVE_RT {
  const base::SampleTime now{engine->now(), 0};
  for (const auto& input : inputs) input->panic(clock);
  for (int channel = 0; channel < kChannelCount; ++channel) {
    for (const int controller : {kAllSoundOff, kResetControllers}) {
      Event& event = add_event(now);
      event.midi.bytes[0] = static_cast<std::uint8_t>(0xB0 | channel);
      event.midi.bytes[1] = static_cast<std::uint8_t>(controller);
      record(event);
    }
    Event& event = add_event(now);
    event.kind = Event::Kind::set_target;
    event.midi.bytes[0] = static_cast<std::uint8_t>(channel);
    event.slot = Event::kEverySlot;
    record(event);
  }
}

/// When an exact event is played: where it says, but no earlier than now and before `end`.
base::SampleTime LiveEngine::State::time_of(const Event& exact, std::int64_t first,
                                            std::int64_t end) const KNOTWAVE_RT {
  const base::SampleTime now{engine->now(), 0};
  const base::SampleTime time{first + exact.time().sample, exact.time().fraction};
  return time.sample >= end ? base::SampleTime{end - 1, 0} : std::max(time, now);
}

// Adds what is due before `end` to the events, in order of time, and says up to where they are
// complete: `end`, unless there were too many.
std::int64_t LiveEngine::State::gather(std::span<const Event>& exact, std::int64_t first,
                                       std::int64_t end) KNOTWAVE_RT {
  for (;;) {
    const int input = next_input();
    const PlacedMessage* live =
        input < 0 ? nullptr : inputs[static_cast<std::size_t>(input)]->front();
    if (live != nullptr && live->sample >= end) live = nullptr;
    if (live == nullptr && exact.empty()) return end;
    const base::SampleTime exact_at =
        exact.empty() ? base::SampleTime{end, 0} : time_of(exact.front(), first, end);
    const bool takes_exact = live == nullptr || exact_at <= base::SampleTime{live->sample, 0};
    if (event_count == events.size()) return takes_exact ? exact_at.sample : live->sample;
    if (takes_exact) {
      add_exact(exact.front(), exact_at);
      exact = exact.subspan(1);
    } else {
      add_message(*live);
      inputs[static_cast<std::size_t>(input)]->pop(clock);
    }
  }
}

/// The input whose next message comes first, or -1.
int LiveEngine::State::next_input() const KNOTWAVE_RT {
  int first = -1;
  const PlacedMessage* best = nullptr;
  for (int i = 0; i < kLiveInputs; ++i) {
    const PlacedMessage* candidate = inputs[static_cast<std::size_t>(i)]->front();
    if (candidate == nullptr || (best != nullptr && !is_before(*candidate, *best))) continue;
    best = candidate;
    first = i;
  }
  return first;
}

Event& LiveEngine::State::add_event(base::SampleTime time) KNOTWAVE_RT {
  // In order even where a caller's exact ones are not.
  const base::SampleTime before = event_count == 0 ? time : events[event_count - 1].time();
  Event& event = events[event_count++];
  event = {};
  event.midi.time = std::max(time, before);
  return event;
}

void LiveEngine::State::add_message(const PlacedMessage& placed) KNOTWAVE_RT {
  const LiveMessage& message = placed.message;
  auto& bytes = sysex[event_count];
  Event& event = add_event({placed.sample, 0});
  std::copy_n(message.bytes, 3, event.midi.bytes);
  event.midi.port = message.port;
  switch (message.kind) {
    case LiveMessage::Kind::midi:
      if (message.sysex_size > 0) {
        bytes = message.sysex;
        event.midi.sysex = bytes.data();
        event.midi.sysex_size = std::min<std::uint32_t>(message.sysex_size, LiveMessage::kMaxSysex);
      }
      std::copy_n(message.bytes, 3, status.last_midi);
      break;
    case LiveMessage::Kind::tempo:
      event.kind = Event::Kind::tempo;
      event.microseconds_per_quarter =
          message.number >= 1
              ? static_cast<std::uint32_t>(std::min(message.number, kMostMicroseconds) + 0.5)
              : 0;
      break;
    case LiveMessage::Kind::set_target:
      event.kind = Event::Kind::set_target;
      event.midi.bytes[0] &= 15;
      event.slot = message.index;
      event.number = message.number;
      break;
    case LiveMessage::Kind::all_notes_off:
      event.kind = Event::Kind::all_notes_off;
      break;
    case LiveMessage::Kind::position:
      event.kind = Event::Kind::position;
      event.song_clocks = message.number > 0
                              ? static_cast<std::int64_t>(std::min(message.number, kMostSongClocks))
                              : 0;
      break;
  }
  record(event);
}

void LiveEngine::State::add_exact(const Event& exact, base::SampleTime at) KNOTWAVE_RT {
  // A bank comes by install(), which keeps it.
  if (exact.kind == Event::Kind::install_bank) return;
  auto& bytes = sysex[event_count];
  Event& event = add_event(at);
  const base::SampleTime time = event.time();
  event = exact;
  event.midi.time = time;
  // What the journal cannot hold is not played either.
  const bool fits = exact.midi.sysex != nullptr && exact.midi.sysex_size <= bytes.size();
  event.midi.sysex = fits ? bytes.data() : nullptr;
  event.midi.sysex_size = fits ? exact.midi.sysex_size : 0;
  if (fits) std::copy_n(exact.midi.sysex, exact.midi.sysex_size, bytes.begin());
  if (exact.kind == Event::Kind::midi) {
    std::copy_n(exact.midi.bytes, 3, status.last_midi);
    ++exact_messages;
  }
  record(event);
}

void LiveEngine::State::record(const Event& event) KNOTWAVE_RT {
  JournalRecord record;
  record.time = event.midi.time;
  record.kind = event.kind;
  record.note = event.note;
  std::copy_n(event.midi.bytes, 3, record.bytes);
  switch (event.kind) {
    case Event::Kind::midi:
      record.sysex_size = static_cast<std::uint8_t>(event.midi.sysex_size);
      std::copy_n(event.midi.sysex, event.midi.sysex_size, record.sysex.begin());
      break;
    case Event::Kind::tempo:
      record.number = event.microseconds_per_quarter;
      break;
    case Event::Kind::install_bank:
      record.index = playing->number;
      break;
    case Event::Kind::set_target:
    case Event::Kind::set_note:
      record.index = event.slot;
      record.number = event.number;
      record.bytes[0] = static_cast<std::uint8_t>(event.midi.channel());
      record.every_channel = event.every_channel;
      record.is_expression = event.is_expression;
      break;
    case Event::Kind::position:
      record.number = static_cast<double>(event.song_clocks);
      break;
    case Event::Kind::choke:
      record.bytes[0] = static_cast<std::uint8_t>(event.midi.channel());
      record.every_channel = event.every_channel;
      break;
    case Event::Kind::all_notes_off:
      break;
  }
  if (!journal.push(record)) ++status.journal_dropped;
}

void LiveEngine::State::publish_status() KNOTWAVE_RT {
  status.now = engine->now();
  status.counters = engine->counters();
  status.messages = exact_messages;
  status.messages_late = status.messages_dropped = 0;
  for (const auto& input : inputs) {
    status.messages += input->heard();
    status.messages_late += input->late();
    status.messages_dropped += input->stale();
  }
  const Engine::Newest newest = engine->newest();
  status.envelope_position = newest.patch == nullptr ? -1 : newest.envelope_place;
  status.envelope_patch = -1;
  const auto patches = playing->program->patches();
  for (std::size_t i = 0; newest.patch != nullptr && i < patches.size(); ++i) {
    if (patches[i].get() == newest.patch) status.envelope_patch = static_cast<int>(i);
  }
  status.tap_dropped_frames = tap.dropped_frames();
  status.latency_frames = clock.latency_frames();
  published.publish(status);
}

}  // namespace knotwave::engine
