// SPDX-License-Identifier: MIT
#include "midi_cable.h"

namespace knotwave::io {
namespace {

constexpr std::uint8_t kActiveSensing = 0xFE;
constexpr std::int64_t kSilenceNs = 300'000'000;

}  // namespace

MidiCable::MidiCable(int port, MidiListener& listener, std::int64_t messages, std::int64_t faults)
    : listener_(&listener),
      port_(port),
      faults_before_(faults),
      messages_(messages),
      faults_(faults) {}

void MidiCable::receive(std::span<const std::uint8_t> bytes, std::int64_t time_ns) noexcept {
  const std::lock_guard lock(mutex_);
  if (listener_ == nullptr) return;
  last_ns_ = time_ns;
  for (const std::uint8_t byte : bytes) {
    if (!stream_.feed(byte)) continue;
    base::MidiEvent event = stream_.message();
    event.port = static_cast<std::uint8_t>(port_);
    if (event.bytes[0] == kActiveSensing) is_sensed_ = true;
    messages_.fetch_add(1, std::memory_order_relaxed);
    listener_->message(event, time_ns);
  }
  const MidiStreamCounters& counters = stream_.counters();
  faults_.store(
      faults_before_ + counters.stray_bytes + counters.cut_messages + counters.sysex_too_long,
      std::memory_order_relaxed);
}

void MidiCable::check_sensing(std::int64_t now_ns) noexcept {
  const std::lock_guard lock(mutex_);
  if (is_sensed_ && now_ns - last_ns_ > kSilenceNs) lose();
}

void MidiCable::end_notes() noexcept {
  const std::lock_guard lock(mutex_);
  lose();
}

void MidiCable::end() noexcept {
  const std::lock_guard lock(mutex_);
  lose();
  listener_ = nullptr;
}

void MidiCable::lose() noexcept {
  if (listener_ == nullptr) return;
  is_sensed_ = false;
  stream_.reset();
  listener_->port_lost(port_);
}

}  // namespace knotwave::io
