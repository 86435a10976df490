// SPDX-License-Identifier: MIT
// One MIDI input as its bytes arrive: they are checked, counted and handed on, and the notes of a
// cable that went silent are ended.
#pragma once
#include <atomic>
#include <cstdint>
#include <mutex>
#include <span>

#include "knotwave/io/midi_input.h"
#include "knotwave/io/midi_stream.h"

namespace knotwave::io {

/// Its lock is held for one message, so that the listener has never two calls for one port.
class MidiCable {
 public:
  /// Counting goes on where an earlier cable of this port ended. [control]
  MidiCable(int port, MidiListener& listener, std::int64_t messages, std::int64_t faults);

  /// Bytes that arrived at time_ns. [the library's thread]
  void receive(std::span<const std::uint8_t> bytes, std::int64_t time_ns) noexcept;
  /// Tells port_lost() where active sensing was heard but nothing since 300 ms. Source: MIDI 1.0
  /// Detailed Specification 4.2, active sensing. [control]
  void check_sensing(std::int64_t now_ns) noexcept;
  /// port_lost() for whoever was connected; the next may send. [control]
  void end_notes() noexcept;
  /// The same, and nothing comes out any more, even if its library still calls. [control]
  void end() noexcept;

  std::int64_t messages() const noexcept { return messages_; }
  std::int64_t faults() const noexcept { return faults_; }

 private:
  void lose() noexcept;

  std::mutex mutex_;
  MidiStream stream_;
  MidiListener* listener_;  ///< null after end()
  int port_;
  bool is_sensed_ = false;  ///< FE was heard, so silence means that the cable was pulled
  std::int64_t last_ns_ = 0;
  std::int64_t faults_before_;
  std::atomic<std::int64_t> messages_, faults_;
};

}  // namespace knotwave::io
