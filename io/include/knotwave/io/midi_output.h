// SPDX-License-Identifier: MIT
// A MIDI output: to a port of others, or one of our own that others connect to. JACK by a client of
// our own, which is exact to the sample; the rest over RtMidi, which sends at once.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "knotwave/base/midi_event.h"
#include "knotwave/base/result.h"
#include "knotwave/io/lateness.h"

namespace knotwave::io {

struct MidiOutputConfig {
  /// As list_midi_ports() names them; empty: the first that works. "rtmidi-jack": JACK through
  /// RtMidi, which the list leaves out: at the start of a block.
  std::string api;
  std::string port;  ///< a name, or part of one, in any case; empty: a port of our own
  std::string client_name = "Knotwave";
  std::string own_name = "out";  ///< of our port
  std::shared_ptr<Lateness> lateness =
      nullptr;  ///< where an output that is_timed() counts; may be null
};

/// [control] One thread, but for exists(). midi_sender.h makes a thread for it.
class MidiOutput {
 public:
  /// The inputs of this program leave a port of our own alone. Errors: unknown_name (an API or a
  /// port by a name nobody has, or several; the message lists them), unsupported (no API works,
  /// or built without RtMidi), io_failed.
  static Result<std::unique_ptr<MidiOutput>> open(const MidiOutputConfig& config);
  /// Within 1.1 s, even where the server has gone.
  virtual ~MidiOutput() = default;

  /// One complete message, its status first; system exclusive with F0 and F7. Errors: malformed (no
  /// such message), value_out_of_range (longer than 16,000 bytes, which JACK does not take),
  /// io_failed (the server has gone: destroy this and open another).
  virtual Result<void> send(std::span<const std::uint8_t> message) = 0;

  /// It takes messages before their time, and places them itself.
  virtual bool is_timed() const noexcept { return false; }
  /// Of one that does: the message goes out at `due_ns` by steady_clock_ns() and one block of the
  /// server later, always, exact to the sample; times rise. What is due before the last block began
  /// goes out at the start of the next one. Does not allocate. False: no room now, or longer than
  /// an output takes. [audio]
  virtual bool send_at(const base::MidiEvent& /*event*/, std::int64_t /*due_ns*/) KNOTWAVE_RT {
    return false;
  }
  /// All that send_at() took is out. [any]
  virtual bool is_done() const noexcept { return true; }

  /// False from when the port it sends to, or the server, has gone: destroy it, and open another
  /// when that is back. Of a thread that need not be the sending one. Takes a list of ports.
  virtual bool exists() = 0;

  virtual const std::string& api() const = 0;
  virtual const std::string& name() const = 0;  ///< of the port, ours or theirs
};

}  // namespace knotwave::io
