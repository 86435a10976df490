// SPDX-License-Identifier: MIT
// knotwave-synth in a folder of its own, and under a JACK server of its own.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "apps/render_scene.h"
#include "live/live_clients.h"
#include "live/synth_process.h"
#include "support/jack_clients.h"
#include "support/jack_server.h"

namespace knotwave::synth {

using io::seconds_until;
using support::JackCapture;
using support::JackMidiSender;
using support::JackServer;

inline constexpr const char* kOut1 = "Knotwave:out_1";
inline constexpr const char* kOut2 = "Knotwave:out_2";
inline constexpr const char* kMidiIn = "Knotwave:midi_in";

class SynthProgram : public render::RenderScene {
 protected:
  SynthProcess::Options here() const {
    SynthProcess::Options options;
    options.folder = folder_.path();
    return options;
  }
  SynthProcess::Options at_terminal() const {
    SynthProcess::Options options = here();
    options.has_terminal = true;
    return options;
  }
};

inline JackMidiSender::Message at(std::int64_t frame, std::vector<std::uint8_t> bytes) {
  return {frame, std::move(bytes)};
}
/// A note that is held as long as its sender lives.
inline std::vector<JackMidiSender::Message> held_note() { return {at(0, {0x90, 69, 127})}; }

/// Of this process alone, as tests run side by side.
inline std::string osc_port() { return std::to_string(20000 + ::getpid() % 12000); }

/// Where two channels begin to sound; their size if they never do.
inline std::size_t onset(const std::vector<float>& samples) {
  return static_cast<std::size_t>(
      std::find_if(samples.begin(), samples.end(), [](float x) { return x != 0; }) -
      samples.begin());
}

}  // namespace knotwave::synth
