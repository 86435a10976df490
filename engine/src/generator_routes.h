// SPDX-License-Identifier: MIT
// Which output of which patch goes to which lane of which cable.
#pragma once
#include <bitset>
#include <memory>
#include <span>
#include <vector>

#include "knotwave/engine/envelope_player.h"
#include "knotwave/engine/output_port.h"

namespace knotwave::engine {

inline constexpr std::size_t kKeysOfAllChannels = 2048;

/// Where one output of one patch goes.
struct GeneratorRoute {
  int patch = 0, output = 0;
  OutputSpec spec;
  int port = -1;  ///< -1: OSC or voltage
  bool is_per_voice = false;
  int first_lane = -1, lanes = 0;  ///< of GeneratorRoutes::lanes; another route's if they share it

  /// Channels, and keys with poly pressure, that were told something: 128 (channel - 1) + key.
  std::bitset<kKeysOfAllChannels> told;
};

/// One value on a cable: of a voice, or of the newest voice of the patch that played last.
struct GeneratorLane {
  int port = 0, port_lane = 0;
  int voice = -1;  ///< -1: the newest
  /// Routes that share the destination; more than one only where programs choose between them.
  std::vector<int> routes;
};

struct GeneratorRoutes {
  std::vector<PortSpec> ports;
  std::vector<GeneratorRoute> routes;
  std::vector<GeneratorLane> lanes;
  std::vector<std::vector<int>> ports_of_patches;  ///< [patch][port in the patch]

  /// Number of a patch's port by the name in the patch; "": its first.
  int port(int patch, const EnvelopePatchSpec& spec, const std::string& name) const;

  /// [control] Errors: value_out_of_range, control_conflict. `voices` are the patches' voices.
  static Result<GeneratorRoutes> create(std::span<const EnvelopePatchProgram* const> patches,
                                        std::span<const int> voices);
};

/// What is added to an output's number to make it a step.
constexpr double step_offset(OutputKind kind) KNOTWAVE_RT {
  return kind == OutputKind::pitch_bend ? 8192 : 0;
}

}  // namespace knotwave::engine
