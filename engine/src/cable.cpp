// SPDX-License-Identifier: MIT
// Bytes, running status and USB packets.
#include "cable.h"

namespace knotwave::engine {
namespace {

constexpr double kOverloadSeconds = 0.02;

Ticks ticks(double seconds, double rate_hz) {
  return static_cast<Ticks>(std::ceil(seconds * rate_hz * static_cast<double>(kTicksPerSample)));
}

bool is_real_time(std::uint8_t status) { return status >= 0xF8; }

}  // namespace

std::int64_t message_bytes(const base::MidiEvent& event) KNOTWAVE_RT {
  const std::uint8_t status = event.bytes[0];
  if (event.sysex != nullptr || status == 0xF0) return std::int64_t{event.sysex_size} + 2;
  if (status >= 0xF0) return status == 0xF2 ? 3 : status == 0xF1 || status == 0xF3 ? 2 : 1;
  return status >= 0xC0 && status < 0xE0 ? 2 : 3;
}

bool ends_notes(const base::MidiEvent& event) KNOTWAVE_RT {
  constexpr int kAllSoundOff = 120, kAllNotesOff = 123, kSustain = 64;
  const base::MidiStatus status = event.status();
  if (status == base::MidiStatus::note_off) return true;
  if (status == base::MidiStatus::note_on) return event.bytes[2] == 0;
  if (status != base::MidiStatus::control_change) return false;
  const int number = event.bytes[1];
  return number == kAllSoundOff || number >= kAllNotesOff ||
         (number == kSustain && event.bytes[2] < 64);
}

Cable::Cable(const OutputPortConfig& config) : config_(config) {
  const bool is_usb = config.wire == PortSpec::Wire::usb;
  byte_ticks_ = is_din() ? ticks(1 / kDinBytesPerSecond, config.rate_hz) : 0;
  frame_ticks_ = is_usb ? ticks(kUsbFrameSeconds, config.rate_hz) : 0;
  spacing_ = is_din() ? 0 : is_usb ? frame_ticks_ : kTicksPerSample;
  part_ticks_ = ticks(1.0 / kUseParts, config.rate_hz);
  packet_.fill(-frame_ticks_);
}

std::int64_t Cable::bytes_now(const base::MidiEvent& event) const KNOTWAVE_RT {
  const std::int64_t bytes = message_bytes(event);
  const bool is_left_out =
      has_running_status() && event.bytes[0] == running_ && event.bytes[0] < 0xF0;
  return is_left_out ? bytes - 1 : bytes;
}

std::int64_t Cable::send(const base::MidiEvent& event, Ticks begin, bool is_thru) KNOTWAVE_RT {
  const std::int64_t bytes = bytes_now(event);
  if (event.bytes[0] < 0xF0) {
    running_ = event.bytes[0];
  } else if (!is_real_time(event.bytes[0])) {
    running_ = 0;  // system common ends running status, real time does not (MIDI 1.0)
  }
  free_at_ = begin + time_of_bytes(bytes);
  if (frame_ticks_ != 0) occupy_packets(bytes, begin);
  counters_.messages += 1;
  counters_.bytes += bytes;
  if (is_thru) counters_.thru_bytes += bytes;
  count_use(load(bytes), begin);
  return bytes;
}

/// No more than 16 events begin within a frame, wherever the host's frames lie: the 17th waits
/// until a frame after the first.
void Cable::occupy_packets(std::int64_t bytes, Ticks begin) KNOTWAVE_RT {
  const std::int64_t events = (bytes + 2) / 3;
  const auto kept = static_cast<std::int64_t>(kPacketEvents);
  const Ticks end = begin + (events - 1) / kept * frame_ticks_;
  for (std::int64_t i = 0; i < std::min(events, kept); ++i) {
    packet_[oldest_] = end;
    oldest_ = (oldest_ + 1) % kPacketEvents;
  }
  free_at_ = std::max(begin, packet_[oldest_] + frame_ticks_);
}

std::int64_t Cable::load(std::int64_t bytes) const KNOTWAVE_RT {
  return frame_ticks_ != 0 ? (bytes + 2) / 3 : bytes;
}

void Cable::count_use(std::int64_t load, Ticks begin) KNOTWAVE_RT {
  update_use(begin);
  use_[static_cast<std::size_t>(use_part_ % kUseParts)] += load;
  use_sum_ += load;
}

void Cable::update_use(Ticks now) KNOTWAVE_RT {
  const std::int64_t part = now / part_ticks_;
  const std::int64_t passed = std::min<std::int64_t>(part - use_part_, kUseParts);
  for (std::int64_t i = 0; i < passed; ++i) {
    std::int64_t& old = use_[static_cast<std::size_t>((part - i) % kUseParts)];
    use_sum_ -= old;
    old = 0;
  }
  use_part_ = std::max(use_part_, part);
  const double budget = is_din()            ? kDinBytesPerSecond
                        : frame_ticks_ != 0 ? static_cast<double>(kPacketEvents) / kUsbFrameSeconds
                                            : 0;
  counters_.use = budget == 0 ? 0 : static_cast<double>(use_sum_) / budget;
}

void Cable::count_arrival(std::int64_t bytes, std::int64_t waiting_bytes) KNOTWAVE_RT {
  const double room = is_din()            ? kOverloadSeconds * kDinBytesPerSecond
                      : frame_ticks_ != 0 ? kOverloadSeconds / kUsbFrameSeconds * 3 * kPacketEvents
                                          : 0;
  if (room != 0 && static_cast<double>(waiting_bytes) > room) counters_.overload_bytes += bytes;
}

void Cable::count_wait(Ticks waited) KNOTWAVE_RT {
  const double seconds =
      static_cast<double>(waited) / (static_cast<double>(kTicksPerSample) * config_.rate_hz);
  counters_.most_waiting_s = std::max(counters_.most_waiting_s, seconds);
}

}  // namespace knotwave::engine
