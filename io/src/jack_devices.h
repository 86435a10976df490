// SPDX-License-Identifier: MIT
// A JACK client and the physical outputs it sees.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include <jack/jack.h>

namespace knotwave::io {

struct JackClose {
  void operator()(jack_client_t* client) const noexcept { jack_client_close(client); }
};
using JackClient = std::unique_ptr<jack_client_t, JackClose>;

/// Playback ports of one client of the server, such as "system", in the server's order.
struct JackOutputs {
  std::string name;
  std::vector<std::string> ports;  ///< full names
};

std::vector<JackOutputs> physical_outputs(jack_client_t* client);

/// Why jack_client_open() gave none: "no server is running".
std::string refusal(jack_status_t status);

}  // namespace knotwave::io
