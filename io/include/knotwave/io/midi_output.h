// SPDX-License-Identifier: MIT
// A MIDI output over RtMidi: to a port of others, or one of our own that others connect to.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "knotwave/base/result.h"

namespace knotwave::io {

struct MidiOutputConfig {
  std::string api;   ///< as list_midi_ports() names them; empty: the first that works
  std::string port;  ///< part of a name in any case; empty: a port of our own
  std::string client_name = "Knotwave";
  std::string own_name = "out";  ///< of our port
};

/// [control] One thread. RtMidi sends at once, with JACK at the start of the next block: who wants
/// a message earlier or later waits until then.
class MidiOutput {
 public:
  /// The inputs of this program leave a port of our own alone. Errors: unknown_name (an API or a
  /// port by a name nobody has, or several; the message lists them), unsupported (no API works,
  /// or built without RtMidi).
  static Result<std::unique_ptr<MidiOutput>> open(const MidiOutputConfig& config);
  /// Within 1.1 s, even where the server has gone.
  virtual ~MidiOutput() = default;

  /// One complete message, its status first; system exclusive with F0 and F7. Errors: malformed (no
  /// such message), value_out_of_range (longer than 16,000 bytes, which JACK does not take),
  /// io_failed (the server has gone: destroy this and open another).
  virtual Result<void> send(std::span<const std::uint8_t> message) = 0;
  virtual const std::string& api() const = 0;
  virtual const std::string& name() const = 0;  ///< of the port, ours or theirs
};

}  // namespace knotwave::io
