// SPDX-License-Identifier: MIT
#include "knotwave/io/midi_stream.h"

namespace knotwave::io {
namespace {

constexpr std::uint8_t kSysex = 0xF0, kEndOfSysex = 0xF7;

constexpr bool is_real_time(std::uint8_t status) { return status >= 0xF8; }

constexpr bool is_undefined(std::uint8_t status) {
  return status == 0xF4 || status == 0xF5 || status == 0xF9 || status == 0xFD;
}

/// Data bytes that follow a status below F8; F0 and undefined ones are not asked for.
constexpr int data_count(std::uint8_t status) {
  switch (status & 0xF0) {
    case 0xC0:
    case 0xD0:
      return 1;
    case 0xF0:
      return status == 0xF2 ? 2 : status == 0xF6 ? 0 : 1;
    default:
      return 2;
  }
}

}  // namespace

MidiStream::MidiStream(std::size_t max_sysex_bytes) : sysex_(max_sysex_bytes) {}

bool MidiStream::feed(std::uint8_t byte) KNOTWAVE_RT {
  if (byte < 0x80) return feed_data(byte);
  if (!is_real_time(byte)) return feed_status(byte);
  if (is_undefined(byte)) {
    ++counters_.stray_bytes;
    return false;
  }
  message_ = {.bytes = {byte, 0, 0}};
  return true;
}

bool MidiStream::feed_data(std::uint8_t byte) KNOTWAVE_RT {
  if (status_ == kSysex) {
    if (sysex_size_ < sysex_.size()) {
      sysex_[sysex_size_++] = byte;
    } else if (sysex_size_ == sysex_.size()) {
      ++sysex_size_;
      ++counters_.sysex_too_long;
    }
    return false;
  }
  if (status_ == 0) {
    ++counters_.stray_bytes;
    return false;
  }
  const bool has_two = data_count(status_) == 2;
  if (has_two && !has_data_) {
    data_ = byte;
    has_data_ = true;
    return false;
  }
  message_ = {.bytes = {status_, has_two ? data_ : byte, has_two ? byte : std::uint8_t{0}}};
  has_data_ = false;
  is_complete_ = true;
  if (status_ >= kSysex) status_ = 0;  // system common does not run on
  return true;
}

bool MidiStream::feed_status(std::uint8_t byte) KNOTWAVE_RT {
  if (byte == kEndOfSysex && status_ == kSysex) return end_sysex();
  const bool is_half_read = status_ == kSysex ? sysex_size_ <= sysex_.size()  // else counted before
                                              : status_ != 0 && (has_data_ || !is_complete_);
  if (is_half_read) ++counters_.cut_messages;
  reset();
  if (byte == kEndOfSysex || is_undefined(byte)) {
    ++counters_.stray_bytes;
    return false;
  }
  if (byte != kSysex && data_count(byte) == 0) {
    message_ = {.bytes = {byte, 0, 0}};
    return true;
  }
  status_ = byte;
  return false;
}

bool MidiStream::end_sysex() KNOTWAVE_RT {
  const std::size_t size = sysex_size_;
  reset();
  if (size > sysex_.size()) return false;
  message_ = {.bytes = {kSysex, 0, 0},
              .sysex_size = static_cast<std::uint32_t>(size),
              .sysex = sysex_.data()};
  return true;
}

void MidiStream::reset() KNOTWAVE_RT {
  status_ = 0;
  sysex_size_ = 0;
  has_data_ = false;
  is_complete_ = false;
}

}  // namespace knotwave::io
