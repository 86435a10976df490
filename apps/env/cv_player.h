// SPDX-License-Identifier: MIT
// Control voltage of several patches as the channels of an audio interface.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "knotwave/engine/voltage_output.h"

#include "patch_players.h"

namespace knotwave::env {

class CvPlayer {
 public:
  static constexpr std::size_t kMostSamples = engine::EnvelopePlayer::kMostSamples;

  /// [control] `config.rate_hz` is that of the players. Errors: those of the players and of
  /// VoltageOutput::create().
  static Result<CvPlayer> create(const engine::VoltageConfig& config, std::uint64_t seed,
                                 const std::vector<const engine::EnvelopePatchProgram*>& programs);

  /// Channels 1 to the highest that a patch names.
  std::size_t channels() const KNOTWAVE_RT { return outputs_.size(); }
  std::int64_t now() const KNOTWAVE_RT { return players_.now(); }
  void handle(const engine::Event& event) KNOTWAVE_RT { players_.handle(event); }
  /// The next n <= kMostSamples samples of each channel; out[c] has room for them. [audio]
  void render(std::size_t n, std::span<float* const> out) KNOTWAVE_RT;
  /// Gates close, and every channel goes to 0 V from now on. [audio]
  void ramp_out() KNOTWAVE_RT;
  bool is_silent() const KNOTWAVE_RT;
  std::int64_t clamped() const KNOTWAVE_RT;

 private:
  /// A gate of a place event: open from a sample to another.
  struct Gate {
    std::size_t patch = 0, event = 0, channel = 0;
    double volts = 0;
    bool is_open = false;
  };
  struct Route {
    std::size_t patch = 0, output = 0, channel = 0;
  };
  explicit CvPlayer(PatchPlayers players) : players_(std::move(players)) {}
  void add_gates(std::int64_t first, std::size_t n) KNOTWAVE_RT;

  PatchPlayers players_;
  std::vector<engine::VoltageOutput> outputs_;
  std::vector<Route> routes_;
  std::vector<Gate> gates_;
  std::vector<std::array<double, kMostSamples>> volts_;  ///< [channel]
};

}  // namespace knotwave::env
