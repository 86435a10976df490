// SPDX-License-Identifier: MIT
// A thread that hands complete messages to MIDI outputs when they are due. RtMidi sends at once, so
// somebody has to wait; outputs that place messages themselves (JACK) get them before.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "knotwave/base/midi_event.h"
#include "knotwave/base/result.h"
#include "knotwave/io/lateness.h"
#include "knotwave/io/midi_output.h"

namespace knotwave::io {

struct MidiSenderConfig {
  std::vector<MidiOutputConfig> ports;  ///< `lateness` of each is the sender's own
  std::size_t waiting = 8192;           ///< messages of a port that are not due yet
  std::size_t waiting_sysex_bytes = 65536;
  bool is_woken = false;  ///< who pushes calls wake() behind it
  std::function<Result<std::unique_ptr<MidiOutput>>(const MidiOutputConfig&)> open =
      MidiOutput::open;
};

struct MidiSenderPort {
  std::string api, name;  ///< as they are, or were while it was there
  bool is_open = false;
  std::string fault;           ///< why it is not
  std::int64_t sent = 0;       ///< handed to the output
  std::int64_t dropped = 0;    ///< no room, no port, or refused by the output
  std::int64_t reopened = 0;   ///< times it came back: what it shows is unknown since
  Lateness::Figures lateness;  ///< of sending; of an output that is_timed(): of its place
};

/// Open from open() to the destructor. [control] of one thread, unless said otherwise.
class MidiSender {
 public:
  /// How long before it is due a message must be pushed to be in time: the thread wakes so often,
  /// unless it is woken. Then it sleeps until something is due.
  static constexpr std::int64_t kWakeNs = 250'000;

  /// Errors: those of MidiOutput::open() for the first port that fails, io_failed (no thread).
  static Result<std::unique_ptr<MidiSender>> open(MidiSenderConfig config);
  /// What has not been sent is dropped. Within 1 s, even where a library hangs: the thread is then
  /// left behind.
  ~MidiSender();
  MidiSender(const MidiSender&) = delete;
  MidiSender& operator=(const MidiSender&) = delete;

  /// A message for port 0, 1, ... of the configuration at `due_ns` by steady_clock_ns(). System
  /// exclusive is copied. Of one port messages go in the order they were pushed, none before it is
  /// due. False: it was dropped, and counted. [audio] of one thread
  bool push(int port, const base::MidiEvent& event, std::int64_t due_ns) KNOTWAVE_RT;

  /// There are new messages. One system call where the thread sleeps. [any]
  void wake() noexcept;

  /// Looks for ports that vanished or came back: call it some ten times a second. True if one did.
  bool poll();
  std::vector<MidiSenderPort> ports() const;
  /// Nothing is waiting any more.
  bool is_done() const;
  /// Empty: the thread runs before all ordinary ones (SCHED_FIFO). Else why it does not.
  std::string why_not_realtime() const;

 private:
  struct State;
  explicit MidiSender(std::shared_ptr<State> state);
  std::shared_ptr<State> state_;  ///< the thread's as well
};

}  // namespace knotwave::io
