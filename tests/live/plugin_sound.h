// SPDX-License-Identifier: MIT
// What the plugins are played with in hosts under a JACK server, and what is heard then.
#pragma once
#include <string>
#include <vector>

#include "support/jack_clients.h"

namespace knotwave::support {

constexpr std::size_t kHeardFrames = 48000;
/// The notes come so much later than the instrument is switched on: parameters glide to their
/// places.
constexpr std::size_t kFramesBefore = 4800;

std::vector<JackMidiSender::Message> plugin_notes();

struct Heard {
  std::vector<float> left, right;
};
/// What the instrument itself gives for plugin_notes().
Heard rendered(double pan = 0);

/// False where the port does not come.
bool comes(const std::string& port, int seconds);

/// Plays plugin_notes() into one port, and hears `expected` at the very sample at two others.
void expect_heard(const std::string& notes_in, const std::string& left_out,
                  const std::string& right_out, const Heard& expected);

}  // namespace knotwave::support
