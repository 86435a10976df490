// SPDX-License-Identifier: MIT
#include "piece.h"

#include <algorithm>

#include "knotwave/base/elementary.h"

namespace knotwave::engine {
namespace {

/// Fewer samples than this over all voices are not worth a wake.
constexpr std::size_t kSamplesWorthAWake = 1024;

}  // namespace

Piece::Piece(const EngineConfig& config, Performance& performance)
    : performance_(performance),
      volume_lin_(base::db_to_gain(config.volume_db)),
      scratches_(static_cast<std::size_t>(config.threads)),
      voice_left_(performance.slots().all().size() * kFrames),
      voice_right_(voice_left_.size()),
      voice_frames_(performance.slots().all().size()),
      voice_bus_(voice_frames_.size()) {
  voices_.reserve(performance.slots().all().size());
  for (ChannelBus& bus : buses_) bus.prepare(config.rate_hz, kFrames);
}

void Piece::reset() KNOTWAVE_RT {
  first_ = 0;
  frames_ = 0;
  is_open_ = false;
  for (int c = 0; c < kChannels; ++c) {
    buses_[static_cast<std::size_t>(c)].reset(performance_.channel(c), volume_lin_);
  }
}

void Piece::open() KNOTWAVE_RT {
  if (is_open_) return;
  is_open_ = true;
  voices_.clear();
  bus_sounds_.fill(false);
  bus_frames_.fill(0);
  buses_used_ = performance_.slots().sounding_buses();
  const auto slots = performance_.slots().all();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i].state == VoiceSlot::State::free) continue;
    voices_.push_back(static_cast<int>(i));
    voice_frames_[i] = 0;
    voice_bus_[i] = slots[i].bus;
  }
}

// Who has come to its end by now leaves its place to what is played.
void Piece::free_ended() KNOTWAVE_RT {
  for (const int i : voices_) {
    if (performance_.slots().at(i).state == VoiceSlot::State::free ||
        !performance_.voice(i).may_end_by(now()))
      continue;
    bring(i);
    performance_.collect(i);
  }
}

void Piece::play(const Event& event, base::SampleTime time) KNOTWAVE_RT {
  open();
  free_ended();
  prepare(performance_.reach_of(event));
  performance_.handle(event, time, *this);
  const bool may_move_a_bus =
      event.kind == Event::Kind::midi && (event.midi.status() == base::MidiStatus::control_change ||
                                          event.midi.status() == base::MidiStatus::system);
  if (may_move_a_bus) follow_buses();
}

void Piece::carry_group_over() KNOTWAVE_RT {
  open();
  free_ended();
  performance_.carry_group_over(now(), *this);
}

void Piece::prepare(const Performance::Reach& reach) KNOTWAVE_RT {
  for (const int i : voices_) {
    if (reach.holds(performance_.slots().at(i))) bring(i);
  }
  for (int c = 0; c < kChannels; ++c) {
    if (reach.mixes(c)) mix_bus(c);
  }
}

void Piece::follow_buses() KNOTWAVE_RT {
  const std::uint32_t sounding = performance_.slots().sounding_buses();
  for (int c = 0; c < kChannels; ++c) {
    const bool is_silent = (sounding >> c & 1) == 0;
    // What ended in this piece was heard before the bus comes to rest.
    if (is_silent && (buses_used_ >> c & 1) != 0) mix_bus(c);
    buses_[static_cast<std::size_t>(c)].follow(
        performance_.channel(c), volume_lin_ * performance_.master_gain(), now(), is_silent);
  }
}

void Piece::bring(int voice) KNOTWAVE_RT {
  render(voice, scratches_[0]);
  performance_.slots().at(voice).level = performance_.voice(voice).level();
}

void Piece::add(int voice) KNOTWAVE_RT {
  const auto i = static_cast<std::size_t>(voice);
  const int bus = performance_.slots().at(voice).bus;
  const auto place = std::lower_bound(voices_.begin(), voices_.end(), voice);
  if (place == voices_.end() || *place != voice) {
    voices_.insert(place, voice);
    voice_frames_[i] = 0;
  } else if (voice_bus_[i] != bus) {  // what ended in this place goes where it belongs
    silence(voice);
    mix_bus(voice_bus_[i]);
    voice_frames_[i] = 0;
  }
  silence(voice);
  voice_bus_[i] = bus;
  buses_used_ |= 1u << bus;
}

/// From where it is rendered to up to now.
void Piece::silence(int voice) KNOTWAVE_RT {
  std::size_t& done = voice_frames_[static_cast<std::size_t>(voice)];
  for (auto* side : {&voice_left_, &voice_right_}) {
    const std::span<float> rest = side_of(*side, voice).subspan(done);
    std::fill(rest.begin(), rest.end(), 0.0F);
  }
  done = frames_;
}

void Piece::render(int voice, VoiceScratch& scratch) KNOTWAVE_RT {
  std::size_t& done = voice_frames_[static_cast<std::size_t>(voice)];
  if (done == frames_) return;
  performance_.voice(voice).render(first_ + static_cast<std::int64_t>(done), performance_.tempo(),
                                   scratch, side_of(voice_left_, voice).subspan(done),
                                   side_of(voice_right_, voice).subspan(done));
  done = frames_;
}

void Piece::render_all() KNOTWAVE_RT {
  std::size_t samples = 0;
  for (const int i : voices_) samples += frames_ - voice_frames_[static_cast<std::size_t>(i)];
  sharing_ = 1;
  if (workers_ && voices_.size() > 1 && samples >= kSamplesWorthAWake) {
    sharing_ = workers_->threads();
    workers_->run([](void* self, int thread) { static_cast<Piece*>(self)->render_share(thread); },
                  this);
  } else {
    render_share(0);
  }
}

void Piece::render_share(int thread) KNOTWAVE_RT {
  for (auto i = static_cast<std::size_t>(thread); i < voices_.size();
       i += static_cast<std::size_t>(sharing_)) {
    render(voices_[i], scratches_[static_cast<std::size_t>(thread)]);
  }
}

void Piece::mix_bus(int bus) KNOTWAVE_RT {
  const auto b = static_cast<std::size_t>(bus);
  const std::size_t at = bus_frames_[b], n = frames_ - at;
  if (n == 0) return;
  bus_frames_[b] = frames_;
  bool sounds = bus_sounds_[b];
  if (sounds) buses_[b].clear(at, frames_);
  for (const int voice : voices_) {
    if (voice_bus_[static_cast<std::size_t>(voice)] != bus) continue;
    if (!sounds) buses_[b].clear(0, frames_);
    sounds = true;
    render(voice, scratches_[0]);
    buses_[b].add(at, side_of(voice_left_, voice).subspan(at),
                  side_of(voice_right_, voice).subspan(at));
  }
  bus_sounds_[b] = sounds;
  if (sounds) buses_[b].finish(first_ + static_cast<std::int64_t>(at), at, n);
}

void Piece::close(std::span<float> left, std::span<float> right,
                  std::span<const Engine::Stem> stems, std::size_t offset) KNOTWAVE_RT {
  open();
  render_all();
  std::fill(left.begin(), left.end(), 0.0F);
  std::fill(right.begin(), right.end(), 0.0F);
  for (int c = 0; c < kChannels; ++c) {
    const auto bus = static_cast<std::size_t>(c);
    mix_bus(c);
    ChannelBus::Sides sides;
    if (bus_sounds_[bus]) sides = buses_[bus].sides(frames_);
    for (std::size_t i = 0; i < sides.left.size(); ++i) {
      left[i] += sides.left[i];
      right[i] += sides.right[i];
    }
    if (bus >= stems.size()) continue;
    const auto stem_left = stems[bus].left.subspan(offset, frames_);
    const auto stem_right = stems[bus].right.subspan(offset, frames_);
    std::fill(stem_left.begin(), stem_left.end(), 0.0F);
    std::fill(stem_right.begin(), stem_right.end(), 0.0F);
    std::copy(sides.left.begin(), sides.left.end(), stem_left.begin());
    std::copy(sides.right.begin(), sides.right.end(), stem_right.begin());
  }
  first_ = now();
  frames_ = 0;
  is_open_ = false;
  performance_.collect();
}

}  // namespace knotwave::engine
