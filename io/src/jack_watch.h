// SPDX-License-Identifier: MIT
// A JACK client without ports that sees what RtMidi does not tell: that the server has gone, all
// names at once, and who is connected to whom. [control]
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "knotwave/base/result.h"

namespace knotwave::io {

class JackWatch {
 public:
  /// Holds the JackTicket of everybody who opens clients only while it lives and closes them
  /// before it. Errors: unsupported (no server, a client that lost its server is still open, JACK
  /// is not built in).
  static Result<std::unique_ptr<JackWatch>> open(const std::string& client_name);
  virtual ~JackWatch() = default;

  /// False from 1 ms after the server has gone. [any]
  virtual bool is_alive() const noexcept = 0;
  /// Full names of MIDI ports, in the server's order. Nothing is asked of the server, so that these
  /// return even where it hangs.
  virtual std::vector<std::string> sources() const = 0;
  virtual std::vector<std::string> sinks() const = 0;
  virtual std::vector<std::string> connections(const std::string& port) const = 0;
};

}  // namespace knotwave::io
