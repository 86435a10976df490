// SPDX-License-Identifier: MIT
// Patches played with devices: MIDI in, MIDI, OSC and control voltage out, and what is told of it.
#pragma once
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "cv_stream.h"
#include "env_input.h"
#include "options.h"
#include "planner.h"

namespace knotwave::env {

/// The outputs that the ports of the patches go to. Errors: usage (a port by a name no patch has).
Result<std::vector<io::MidiOutputConfig>> output_ports(const EnvOptions& options,
                                                       const std::vector<engine::PortSpec>& ports);

class Live {
 public:
  enum class End { signal, duration };

  /// Opens everything. Errors: those of the devices, of the generator and of output_ports().
  static Result<std::unique_ptr<Live>> open(const EnvOptions& options, const EnvInput& input);

  /// Plays until `signals` is not 0 or the duration is over, then brings every destination to rest,
  /// within 3 s.
  End run(const std::atomic<int>& signals);

 private:
  Live(const EnvOptions& options, const EnvInput& input) : options_(options), input_(input) {}
  Result<void> open_outputs();
  Result<void> open_inputs();
  void say_beginning();
  void look();
  void rest();
  void show_status();
  void show_messages();
  std::string input_name() const;

  const EnvOptions& options_;
  const EnvInput& input_;
  std::unique_ptr<engine::EnvelopeGenerator> generator_;
  SentNames names_;
  std::unique_ptr<io::MidiSender> sender_;
  std::unique_ptr<io::OscOutput> osc_;
  std::unique_ptr<CvStream> cv_;
  std::unique_ptr<Planner> planner_;
  std::unique_ptr<io::MidiInputs> inputs_;  ///< goes first: it calls the planner
  std::vector<std::string> told_;           ///< the status lines of a second ago
  std::vector<bool> was_open_;              ///< outputs
  std::vector<std::int64_t> reopened_;      ///< of the outputs, when last seen
};

/// MIDI inputs and outputs and sound devices, as --list prints them.
std::string device_list();

}  // namespace knotwave::env
