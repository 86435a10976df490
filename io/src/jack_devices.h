// SPDX-License-Identifier: MIT
// A JACK client and the physical outputs it sees.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include <jack/jack.h>

#include "jack_session.h"

namespace knotwave::io {

/// Open while it lives. [control]
class JackClient {
 public:
  /// Where it does not open, none, and `why` says so: "no server is running".
  static JackClient open(const std::string& name, std::string& why);

  explicit operator bool() const noexcept { return client_ != nullptr; }
  jack_client_t* get() const noexcept { return client_.get(); }

 private:
  struct Close {
    void operator()(jack_client_t* client) const noexcept { jack_client_close(client); }
  };
  std::unique_ptr<JackTicket> ticket_;  ///< returned after the client is closed
  std::unique_ptr<jack_client_t, Close> client_;
};

/// Playback ports of one client of the server, such as "system", in the server's order.
struct JackOutputs {
  std::string name;
  std::vector<std::string> ports;  ///< full names
};

std::vector<JackOutputs> physical_outputs(jack_client_t* client);

}  // namespace knotwave::io
