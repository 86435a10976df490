// SPDX-License-Identifier: MIT
// What was sent, as a MIDI file and as a table.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "knotwave/io/midi_file.h"

#include "sent_list.h"

namespace knotwave::env {

inline constexpr int kClockHz = 48000;  ///< samples of the virtual clock

/// Names for what a list holds by number.
struct SentNames {
  std::vector<std::string> ports;
  std::vector<std::vector<std::string>> addresses;  ///< [patch][output]
};

/// A track a port, one tick a sample (24000 to the quarter at 120 bpm), so that no time is off by
/// more than half a sample. Clock and other system messages have no place in a file; `left_out`
/// counts them and OSC.
io::Song song_of(std::span<const SentMessage> messages, const SentNames& names, std::int64_t end,
                 std::size_t& left_out);

/// Lines `time_s,port,message,channel,number,value,hex`, the first one with these words. Numbers
/// and values as the message has them: bend -8192..8191, OSC's address and number.
std::string csv_of(std::span<const SentMessage> messages, const SentNames& names);

/// One message in words: "CC 74 = 63 ch 3", "note 60 on 100 ch 1", "/filter/cutoff 0.25".
std::string message_text(const SentMessage& message, const SentNames& names);

}  // namespace knotwave::env
