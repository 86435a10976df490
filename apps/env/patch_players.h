// SPDX-License-Identifier: MIT
// The players of several patches, side by side on one clock.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "knotwave/engine/envelope_player.h"

namespace knotwave::env {

class PatchPlayers {
 public:
  /// [control] Errors: those of EnvelopePlayer::create().
  static Result<PatchPlayers> create(
      double rate_hz, std::uint64_t seed,
      const std::vector<const engine::EnvelopePatchProgram*>& programs) {
    PatchPlayers players;
    players.programs_ = programs;
    engine::EnvelopePlayerConfig config;
    config.rate_hz = rate_hz;
    config.seed = seed;
    for (const auto* program : programs) {
      auto player = engine::EnvelopePlayer::create(config, program);
      if (!player) return player.error();
      players.players_.push_back(std::move(*player));
    }
    return players;
  }

  void handle(const engine::Event& event) KNOTWAVE_RT {
    for (const auto& player : players_) player->handle(event);
  }
  /// The next n <= EnvelopePlayer::kMostSamples samples. [audio]
  void render(std::size_t n) KNOTWAVE_RT {
    for (const auto& player : players_) player->render(n);
    now_ += static_cast<std::int64_t>(n);
  }
  /// Up to sample `until`; after each block block(first, n) is called. [audio] as far as that is
  template <class Block>
  void render_until(std::int64_t until, Block&& block) {
    while (now_ < until) {
      const std::int64_t first = now_;
      const auto n = std::min<std::int64_t>(until - now_, engine::EnvelopePlayer::kMostSamples);
      render(static_cast<std::size_t>(n));
      block(first, static_cast<std::size_t>(n));
    }
  }
  std::int64_t now() const KNOTWAVE_RT { return now_; }

  std::size_t size() const KNOTWAVE_RT { return players_.size(); }
  engine::EnvelopePlayer& player(std::size_t patch) KNOTWAVE_RT { return *players_[patch]; }
  const engine::EnvelopePatchSpec& spec(std::size_t patch) const KNOTWAVE_RT {
    return programs_[patch]->spec();
  }
  /// Of the newest voice, or what it is before there was one. [audio]
  std::span<const double> values(std::size_t patch, std::size_t output) const KNOTWAVE_RT {
    const int newest = players_[patch]->newest_voice();
    return players_[patch]->values(newest < 0 ? 0 : newest, static_cast<int>(output));
  }

 private:
  std::vector<const engine::EnvelopePatchProgram*> programs_;
  std::vector<std::unique_ptr<engine::EnvelopePlayer>> players_;
  std::int64_t now_ = 0;
};

}  // namespace knotwave::env
