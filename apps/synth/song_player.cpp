// SPDX-License-Identifier: MIT
#include "song_player.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "song/event_feed.h"

namespace knotwave::synth {

SongPlayer::SongPlayer(io::Song song) : song_(std::move(song)) {
  due_.reserve(kMostEvents + PortNotes::kMostHeld);
}

void SongPlayer::begin(double rate_hz, double position_s) {
  rate_hz_ = rate_hz;
  song::EventFeed feed(song_, static_cast<int>(std::lround(rate_hz)));
  const auto all = feed.before(std::numeric_limits<std::int64_t>::max());
  events_.assign(all.begin(), all.end());
  // The feed's last event ends everybody's notes; these are let go one by one instead.
  std::erase_if(events_, [](const engine::Event& event) {
    return event.kind == engine::Event::Kind::all_notes_off;
  });
  end_ = feed.end();
  length_s_ = static_cast<double>(end_.sample) / rate_hz;
  const auto now = static_cast<std::int64_t>(std::floor(position_s * rate_hz + 0.5));
  now_ = now;
  held_ = {};
  for (next_ = 0; next_ < events_.size() && events_[next_].time().sample < now; ++next_) {
    if (events_[next_].kind == engine::Event::Kind::midi) held_.heard(events_[next_].midi);
  }
}

std::span<const engine::Event> SongPlayer::due(int frames) KNOTWAVE_RT {
  due_.clear();
  if (is_over()) return due_;
  const std::int64_t from = now_.load(std::memory_order_relaxed), until = from + frames;
  now_.store(until, std::memory_order_relaxed);
  if (is_stopped_.load(std::memory_order_relaxed)) {
    let_go({0, 0});
    return due_;
  }
  while (next_ < events_.size() && events_[next_].time().sample < until &&
         due_.size() < kMostEvents) {
    add(events_[next_++], from);
  }
  if (next_ == events_.size() && end_.sample < until) {
    let_go({std::max(end_.sample - from, std::int64_t{0}), end_.fraction});
  }
  return due_;
}

void SongPlayer::add(const engine::Event& event, std::int64_t from) KNOTWAVE_RT {
  due_.push_back(event);
  // Those that found no room in an earlier block come now.
  engine::Event& out = due_.back();
  out.midi.time.sample = std::max(out.midi.time.sample - from, std::int64_t{0});
  if (event.kind == engine::Event::Kind::midi) held_.heard(event.midi);
}

void SongPlayer::let_go(base::SampleTime offset) KNOTWAVE_RT {
  held_.release([&](std::uint8_t status, std::uint8_t first, std::uint8_t second) {
    engine::Event event;
    event.midi.time = offset;
    event.midi.bytes[0] = status;
    event.midi.bytes[1] = first;
    event.midi.bytes[2] = second;
    due_.push_back(event);
  });
  is_over_.store(true, std::memory_order_relaxed);
}

double SongPlayer::position_s() const KNOTWAVE_RT {
  return std::min(static_cast<double>(now_.load(std::memory_order_relaxed)) / rate_hz_, length_s_);
}

}  // namespace knotwave::synth
