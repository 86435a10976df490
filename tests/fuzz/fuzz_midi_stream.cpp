// SPDX-License-Identifier: MIT
// Any bytes on a MIDI cable: whole messages only, each byte accounted for.
#include <cstddef>
#include <cstdint>

#include "knotwave/io/midi_stream.h"

#include "fuzz_check.h"

namespace {

using namespace knotwave;

/// Bytes of a message on the cable, its status included.
std::size_t length_of(const base::MidiEvent& message) {
  const int status = message.bytes[0];
  if (status == 0xF0) return message.sysex_size + std::size_t{2};
  if (status >= 0xF8 || status == 0xF6) return 1;
  const bool has_one = (status & 0xE0) == 0xC0 || status == 0xF1 || status == 0xF3;
  return has_one ? 2 : 3;
}

void check_message(const base::MidiEvent& message, std::size_t limit) {
  const int status = message.bytes[0];
  FUZZ_CHECK(status >= 0x80 && message.bytes[1] < 0x80 && message.bytes[2] < 0x80);
  FUZZ_CHECK(status != 0xF4 && status != 0xF5 && status != 0xF7 && status != 0xF9 &&
             status != 0xFD);
  FUZZ_CHECK(length_of(message) != 2 || message.bytes[2] == 0);
  FUZZ_CHECK(message.sysex_size <= limit);
  FUZZ_CHECK(status == 0xF0 || (message.sysex == nullptr && message.sysex_size == 0));
  for (std::uint32_t i = 0; i < message.sysex_size; ++i) FUZZ_CHECK(message.sysex[i] < 0x80);
}

}  // namespace

/// The first byte is the limit of system exclusive, the rest is the cable.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t limit = bytes[0];
  io::MidiStream stream(limit), plain(limit);
  std::size_t explained = 0, statuses_left_out = 0;
  for (std::size_t i = 1; i < size; ++i) {
    const bool is_message = stream.feed(bytes[i]);
    if (is_message) {
      check_message(stream.message(), limit);
      explained += length_of(stream.message());
      ++statuses_left_out;  // at most one a message
    }
    if (bytes[i] >= 0xF8) {
      FUZZ_CHECK(is_message == (bytes[i] != 0xF9 && bytes[i] != 0xFD));
      continue;
    }
    // Without its real-time bytes the cable says the same.
    FUZZ_CHECK(plain.feed(bytes[i]) == is_message);
    if (!is_message) continue;
    for (int k = 0; k < 3; ++k) {
      FUZZ_CHECK(plain.message().bytes[k] == stream.message().bytes[k]);
    }
    FUZZ_CHECK(plain.message().sysex_size == stream.message().sysex_size);
  }
  const io::MidiStreamCounters& counters = stream.counters();
  FUZZ_CHECK(explained + static_cast<std::size_t>(counters.stray_bytes) <=
             size - 1 + statuses_left_out);
  FUZZ_CHECK(counters.cut_messages + counters.sysex_too_long <= static_cast<long long>(size));
  FUZZ_CHECK(plain.counters().cut_messages == counters.cut_messages);
  return 0;
}
