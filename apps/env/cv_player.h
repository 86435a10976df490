// SPDX-License-Identifier: MIT
// Control voltage of several patches as the channels of an audio interface.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "knotwave/engine/voltage_mix.h"
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
  /// Ramps in again with the next sample. [control, not rendering]
  void begin_again();
  std::int64_t clamped() const KNOTWAVE_RT;

 private:
  CvPlayer(PatchPlayers players, engine::VoltageMix mix)
      : players_(std::move(players)), mix_(std::move(mix)) {}

  PatchPlayers players_;
  engine::VoltageMix mix_;
  std::vector<engine::VoltageOutput> outputs_;
};

}  // namespace knotwave::env
