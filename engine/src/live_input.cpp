// SPDX-License-Identifier: MIT
#include "live_input.h"

#include <algorithm>
#include <array>
#include <bit>

#include "knotwave/engine/channel_state.h"

namespace knotwave::engine {
namespace {

constexpr std::uint32_t kEveryChannel = 0xFFFF;
/// A note-on that waited so much longer than others, because no block was asked for, is dropped:
/// its player has long heard that nothing sounded.
constexpr std::int64_t kStaleFrames = 1 << 16;

bool is_pedal_up(const LiveMessage& m) KNOTWAVE_RT {
  return (m.bytes[1] == kSustain || m.bytes[1] == kSostenuto) && m.bytes[2] < 64;
}

/// The channels, as bits, whose notes it ends.
std::uint32_t channels_ended(const LiveMessage& m) KNOTWAVE_RT {
  if (m.kind == LiveMessage::Kind::all_notes_off) return kEveryChannel;
  if (m.kind != LiveMessage::Kind::midi) return 0;
  const std::uint32_t channel = 1u << (m.bytes[0] & 15);
  switch (m.bytes[0] & 0xF0) {
    case 0x80:
      return channel;
    case 0x90:
      return m.bytes[2] == 0 ? channel : 0;
    case 0xB0:
      return m.bytes[1] == kAllSoundOff || m.bytes[1] >= kAllNotesOff || is_pedal_up(m) ? channel
                                                                                        : 0;
    default:
      return m.bytes[0] == 0xFF ? kEveryChannel : 0;
  }
}

bool is_note_on(const LiveMessage& m) KNOTWAVE_RT {
  return m.kind == LiveMessage::Kind::midi && (m.bytes[0] & 0xF0) == 0x90 && m.bytes[2] > 0;
}

/// Whether it still counts when a panic came after it.
bool survives_panic(const LiveMessage& m) KNOTWAVE_RT {
  if (m.kind == LiveMessage::Kind::tempo || m.kind == LiveMessage::Kind::position) return true;
  if (channels_ended(m) != 0) return true;
  if (m.kind != LiveMessage::Kind::midi) return false;
  const int status = m.bytes[0] & 0xF0;
  const bool is_bank = status == 0xB0 && (m.bytes[1] == kBankMsb || m.bytes[1] == kBankLsb);
  return status == 0xC0 || status == 0xF0 || is_bank;
}

/// Clock, active sensing and the like: the engine gives them no meaning.
bool is_silent(const LiveMessage& m) KNOTWAVE_RT {
  return m.kind == LiveMessage::Kind::midi && m.bytes[0] >= 0xF8 && m.bytes[0] != 0xFF;
}

}  // namespace

LiveInput::LiveInput(int messages)
    : ring_(2 * static_cast<std::size_t>(messages)), ordinary_(ring_.capacity() / 2) {}

bool LiveInput::push(const LiveMessage& message) KNOTWAVE_RT {
  if (is_silent(message)) return true;
  const std::uint32_t ended = channels_ended(message);
  if ((ended != 0 || ring_.size() < ordinary_) && ring_.push(message)) {
    ++pushed_;
    return true;
  }
  dropped_.fetch_add(1, std::memory_order_relaxed);
  if (ended != 0) {
    lost_at_.store(pushed_, std::memory_order_relaxed);
    lost_.fetch_or(ended, std::memory_order_release);
  }
  return false;
}

void LiveInput::begin_block(const LiveClock& clock, std::int64_t now) KNOTWAVE_RT {
  now_ = now;
  // The losses before the ring: then all that was pushed before them is in it.
  if (lost_.load(std::memory_order_relaxed) != 0) {
    losses_ |= lost_.exchange(0, std::memory_order_acquire);
    losses_at_ = lost_at_.load(std::memory_order_relaxed);
    loss_step_ = 0;
  }
  available_ = ring_.size();
  if (!has_front_) load(clock);
}

void LiveInput::panic(const LiveClock& clock) KNOTWAVE_RT {
  panicked_ = available_;
  if (has_front_ && !survives_panic(front_.message)) pop(clock);
}

void LiveInput::pop(const LiveClock& clock) KNOTWAVE_RT {
  has_front_ = false;
  load(clock);
}

void LiveInput::load(const LiveClock& clock) KNOTWAVE_RT {
  if (load_loss()) return;
  while (available_ > 0 && ring_.pop(front_.message)) {
    --available_;
    ++popped_;
    ++heard_;
    const bool is_panicked = panicked_ > 0;
    if (is_panicked) --panicked_;
    has_front_ = (!is_panicked || survives_panic(front_.message)) && place(clock);
    if (has_front_) return;
    if (load_loss()) return;
  }
}

// In place of what was lost: pedals up, then all sound off, one channel after the other.
bool LiveInput::load_loss() KNOTWAVE_RT {
  if (losses_ == 0 || popped_ < losses_at_) return false;
  constexpr std::array<std::uint8_t, 3> kControllers = {kSustain, kSostenuto, kAllSoundOff};
  const int channel = std::countr_zero(losses_);
  front_.message = {};
  front_.message.bytes[0] = static_cast<std::uint8_t>(0xB0 | channel);
  front_.message.bytes[1] = kControllers[static_cast<std::size_t>(loss_step_)];
  front_.sample = last_sample_ = std::max(last_sample_, now_);
  has_front_ = true;
  if (++loss_step_ == static_cast<int>(kControllers.size())) {
    loss_step_ = 0;
    losses_ &= losses_ - 1;
  }
  return true;
}

bool LiveInput::place(const LiveClock& clock) KNOTWAVE_RT {
  std::int64_t sample = now_;
  if (front_.message.time_ns != 0) {
    sample = clock.sample_of(front_.message.time_ns);
    if (sample < now_ - kStaleFrames && is_note_on(front_.message)) {
      ++stale_;
      return false;
    }
    if (sample < now_) ++late_;
  }
  front_.sample = last_sample_ = std::max({sample, now_, last_sample_});
  return true;
}

}  // namespace knotwave::engine
