// SPDX-License-Identifier: MIT
// Bytes of a MIDI cable become complete messages: running status, real-time bytes inside others,
// system exclusive of any length up to a limit. Source: MIDI 1.0 Detailed Specification 4.2.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "knotwave/base/midi_event.h"

namespace knotwave::io {

struct MidiStreamCounters {
  std::int64_t stray_bytes = 0;     ///< data without a status, F7 without F0, undefined F4 F5 F9 FD
  std::int64_t cut_messages = 0;    ///< ended by a new status before they were complete
  std::int64_t sysex_too_long = 0;  ///< dropped whole
};

/// One cable. Memory is given at construction; the rest is for whichever thread reads the cable.
///   - Real-time bytes (F8 FA FB FC FE FF) come out at once and change nothing else, wherever they
///     stand. F9 and FD mean nothing and change nothing either.
///   - Any other status ends a message that is not complete, system exclusive too: it is dropped.
///   - F0 to F7 end running status, also F4 and F5, which mean nothing.
class MidiStream {
 public:
  /// [control] System exclusive with more data than this is dropped whole and counted.
  explicit MidiStream(std::size_t max_sysex_bytes = 65536);

  /// The next byte; true when it completes a message, which is then in message(). [audio]
  bool feed(std::uint8_t byte) KNOTWAVE_RT;
  /// Valid until the next feed(). Its time and port are for the caller to fill. A note-on of
  /// velocity 0 stays one.
  const base::MidiEvent& message() const KNOTWAVE_RT { return message_; }
  /// Forgets running status and what is half read: the cable was pulled. Counters go on. [audio]
  void reset() KNOTWAVE_RT;
  const MidiStreamCounters& counters() const KNOTWAVE_RT { return counters_; }

 private:
  bool feed_data(std::uint8_t byte) KNOTWAVE_RT;
  bool feed_status(std::uint8_t byte) KNOTWAVE_RT;
  bool end_sysex() KNOTWAVE_RT;

  base::MidiEvent message_;
  std::vector<std::uint8_t> sysex_;  ///< size is the limit
  std::size_t sysex_size_ = 0;       ///< may pass the limit by one: too long
  std::uint8_t status_ = 0;          ///< running or awaiting data; F0 in system exclusive; 0: none
  std::uint8_t data_ = 0;            ///< the first of two
  bool has_data_ = false;
  bool is_complete_ = false;  ///< a message came out since status_ was sent
  MidiStreamCounters counters_;
};

}  // namespace knotwave::io
