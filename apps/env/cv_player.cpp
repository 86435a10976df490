// SPDX-License-Identifier: MIT
#include "cv_player.h"

#include <algorithm>

namespace knotwave::env {

Result<CvPlayer> CvPlayer::create(
    const engine::VoltageConfig& config, std::uint64_t seed,
    const std::vector<const engine::EnvelopePatchProgram*>& programs) {
  auto players = PatchPlayers::create(config.rate_hz, seed, programs);
  if (!players) return players.error();
  CvPlayer cv(std::move(*players), engine::VoltageMix(programs));
  for (std::size_t c = 0; c < cv.mix_.channels(); ++c) {
    auto output = engine::VoltageOutput::create(config, static_cast<int>(c) + 1);
    if (!output) return output.error();
    cv.outputs_.push_back(std::move(*output));
  }
  return cv;
}

void CvPlayer::render(std::size_t n, std::span<float* const> out) KNOTWAVE_RT {
  const std::int64_t first = players_.now();
  players_.render(n);
  mix_.begin(first, n);
  for (std::size_t patch = 0; patch < players_.size(); ++patch) {
    for (const engine::PlayerMessage& message : players_.player(patch).take_messages()) {
      mix_.hear(patch, message);
    }
  }
  mix_.end([this](std::size_t patch, std::size_t output)
               KNOTWAVE_RT { return players_.values(patch, output); });
  for (std::size_t c = 0; c < outputs_.size(); ++c) {
    outputs_[c].render(first, mix_.volts(c), {out[c], n});
  }
}

void CvPlayer::ramp_out() KNOTWAVE_RT {
  for (std::size_t patch = 0; patch < players_.size(); ++patch)
    players_.player(patch).release_all();
  for (engine::VoltageOutput& output : outputs_) output.ramp_out(now());
}

void CvPlayer::begin_again() {
  for (engine::VoltageOutput& output : outputs_) output.begin_again();
}

bool CvPlayer::is_silent() const KNOTWAVE_RT {
  return std::all_of(outputs_.begin(), outputs_.end(),
                     [this](const auto& output) { return output.is_silent(now()); });
}

std::int64_t CvPlayer::clamped() const KNOTWAVE_RT {
  std::int64_t count = 0;
  for (const engine::VoltageOutput& output : outputs_) count += output.clamped();
  return count;
}

}  // namespace knotwave::env
