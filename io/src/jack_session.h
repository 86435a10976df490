// SPDX-License-Identifier: MIT
// Which JACK clients of this program are open. When a server goes, libjack frees its clients that
// are still open as soon as another one is opened, and whoever closes his own then touches freed
// memory (seen with 1.9.21: the program ends). So every client takes a ticket, and none is given
// while a client of a server that has gone is still open. Knows nothing of libjack itself.
#pragma once
#include <memory>

namespace knotwave::io {

/// Held while a client is open, and returned after it is closed. [any]
class JackTicket {
 public:
  /// Null: a client that lost its server is still open; try again when it is closed.
  static std::unique_ptr<JackTicket> take();
  /// From the shutdown callback of any client: its server has gone.
  static void server_has_gone() noexcept;
  /// True from then until every client is closed: so close yours, even if it was not told. libjack
  /// takes the server for gone as well when it throws out one client of a program.
  static bool has_server_gone() noexcept;

  ~JackTicket();
  JackTicket(const JackTicket&) = delete;
  JackTicket& operator=(const JackTicket&) = delete;

 private:
  JackTicket() = default;
};

}  // namespace knotwave::io
