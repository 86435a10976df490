// SPDX-License-Identifier: MIT
// Bytes of a MIDI cable become complete messages: running status, real-time bytes inside others,
// system exclusive of any length up to a limit. Source: MIDI 1.0 Detailed Specification 4.2.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "knotwave/base/midi_event.h"

namespace knotwave::io {

struct MidiStreamCounters {
  std::int64_t stray_bytes = 0;     ///< data without a status
  std::int64_t cut_messages = 0;    ///< ended by a new status before they were complete
  std::int64_t sysex_too_long = 0;  ///< dropped whole
};

/// One cable. Memory is given at construction; the rest is for whichever thread reads the cable.
class MidiStream {
 public:
  /// [control] Longer system exclusive is dropped whole and counted.
  explicit MidiStream(std::size_t max_sysex_bytes = 65536);

  /// The next byte; true when it completes a message, which is then in message(). [audio]
  bool feed(std::uint8_t byte) KNOTWAVE_RT;
  /// Valid until the next feed(). Its time and port are for the caller to fill. A note-on of
  /// velocity 0 stays one.
  const base::MidiEvent& message() const KNOTWAVE_RT { return message_; }
  /// Forgets running status and what is half read: the cable was pulled. [audio]
  void reset() KNOTWAVE_RT;
  const MidiStreamCounters& counters() const KNOTWAVE_RT { return counters_; }

 private:
  base::MidiEvent message_;
  std::vector<std::uint8_t> sysex_;
  std::size_t sysex_size_ = 0;
  std::uint8_t status_ = 0;  ///< running, 0 = none
  std::uint8_t data_[2] = {0, 0};
  int have_ = 0;
  bool in_sysex_ = false;
  MidiStreamCounters counters_;
};

}  // namespace knotwave::io
