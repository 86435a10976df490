// SPDX-License-Identifier: MIT
// Patches read and compiled, with what the command line changes in them.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "knotwave/engine/envelope_generator.h"

#include "options.h"
#include "sent_files.h"

namespace knotwave::env {

/// What servers call the outputs. Inputs leave it out unless it is named: two programs would play
/// each other round and round.
inline constexpr const char* kOutputClient = "Knotwave-env";

struct EnvInput {
  std::vector<std::unique_ptr<const engine::EnvelopePatchProgram>> programs;
  std::vector<std::string> warnings;  ///< what in the patches can hardly be meant

  std::vector<const engine::EnvelopePatchProgram*> patches() const;
  bool has_osc() const;
  /// Those with control voltage or gates.
  std::vector<const engine::EnvelopePatchProgram*> voltage_patches() const;
};

/// Errors: those of read_envelope_patch() and EnvelopePatchProgram::create().
Result<EnvInput> read_input(const EnvOptions& options);

/// What --cc and --channel make of a patch: its first output goes to the controller, over the whole
/// range where it was in other units; every output of MIDI to the channel.
void redirect(const EnvOptions& options, engine::EnvelopePatchSpec& patch);

/// The generator that the options ask for. Errors: those of EnvelopeGenerator::create().
Result<std::unique_ptr<engine::EnvelopeGenerator>> make_generator(const EnvOptions& options,
                                                                  const EnvInput& input);
SentNames names_of(const engine::EnvelopeGenerator& generator, const EnvInput& input);

}  // namespace knotwave::env
