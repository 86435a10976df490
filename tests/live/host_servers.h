// SPDX-License-Identifier: MIT
// PulseAudio and PipeWire servers of a test's own, with a null sink and without a sound card.
// Debian packages: pulseaudio pulseaudio-utils libasound2-plugins pipewire pipewire-bin
// pipewire-jack.
#pragma once
#include <csignal>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "live/live_clients.h"
#include "support/background_program.h"
#include "support/program.h"

namespace knotwave::support {

inline void expect_program(const char* name, const char* package) {
  const std::string command = "command -v " + std::string(name);
  ASSERT_EQ(run_program({"/bin/sh", "-c", command}).exit_code, 0)
      << name << " is missing: apt-get install " << package;
}

/// While it lives, this process and its children find this server and no other of its kind.
class HostServer {
 public:
  bool start() {
    program_ = std::make_unique<BackgroundProgram>(words_, folder_.file("log"));
    const auto is_up = [&] {
      return run_program({"/bin/sh", "-c", is_up_ + " >/dev/null 2>&1"}).exit_code == 0;
    };
    return io::seconds_until(is_up, 15) < 15;
  }
  void kill() { program_->end(SIGKILL); }
  const ScratchFolder& folder() const { return folder_; }

 protected:
  explicit HostServer(std::string is_up)
      : is_up_(std::move(is_up)),
        home_("HOME", folder_.path()),
        runtime_("XDG_RUNTIME_DIR", folder_.path()),
        pulse_runtime_("PULSE_RUNTIME_PATH", folder_.path()),
        pipewire_runtime_("PIPEWIRE_RUNTIME_DIR", folder_.path()) {}

  ScratchFolder folder_;
  std::vector<std::string> words_;

 private:
  std::string is_up_;
  SetVariable home_, runtime_, pulse_runtime_, pipewire_runtime_;
  std::unique_ptr<BackgroundProgram> program_;
};

/// ALSA's default leads to it; what is played there can be heard at nul.monitor.
class PulseServer : public HostServer {
 public:
  PulseServer() : HostServer("pactl info") {
    std::ofstream(folder_.file(".asoundrc")) << "pcm.!default { type pulse }\n";
    words_ = {"pulseaudio",
              "-n",
              "--daemonize=no",
              "--exit-idle-time=-1",
              "--disable-shm=yes",
              "--load=module-native-protocol-unix",
              "--load=module-null-sink sink_name=nul rate=48000 format=float32le"};
  }
};

inline constexpr const char* kPipeWireSetup = R"(
context.properties = { core.daemon = true core.name = pipewire-0 support.dbus = false
  default.clock.rate = 48000 default.clock.allowed-rates = [ 44100 48000 ]
  default.clock.quantum = 1024
  default.clock.min-quantum = 1024 default.clock.max-quantum = 1024 }
context.spa-libs = { audio.convert.* = audioconvert/libspa-audioconvert
  support.* = support/libspa-support }
context.modules = [ { name = libpipewire-module-protocol-native }
  { name = libpipewire-module-metadata } { name = libpipewire-module-spa-node-factory }
  { name = libpipewire-module-client-node } { name = libpipewire-module-adapter }
  { name = libpipewire-module-link-factory } { name = libpipewire-module-access } ]
context.objects = [ { factory = adapter args = { factory.name = support.null-audio-sink
  node.name = "null-sink" node.description = "Null" media.class = "Audio/Sink"
  audio.position = "FL,FR" node.pause-on-idle = false
  adapter.auto-port-config = { mode = dsp monitor = true position = preserve } } } ]
)";

class PipeWireServer : public HostServer {
 public:
  PipeWireServer() : HostServer("pw-jack jack_lsp | grep -q Null") {
    std::ofstream(folder_.file("setup.conf")) << kPipeWireSetup;
    words_ = {"pipewire", "-c", folder_.file("setup.conf")};
  }
};

}  // namespace knotwave::support
