// SPDX-License-Identifier: MIT
#include "cv_player.h"

#include <algorithm>

namespace knotwave::env {

Result<CvPlayer> CvPlayer::create(
    const engine::VoltageConfig& config, std::uint64_t seed,
    const std::vector<const engine::EnvelopePatchProgram*>& programs) {
  auto players = PatchPlayers::create(config.rate_hz, seed, programs);
  if (!players) return players.error();
  CvPlayer cv(std::move(*players));
  std::size_t channels = 0;
  for (std::size_t patch = 0; patch < programs.size(); ++patch) {
    const engine::EnvelopePatchSpec& spec = programs[patch]->spec();
    for (std::size_t i = 0; i < spec.outputs.size(); ++i) {
      if (spec.outputs[i].kind != engine::OutputKind::voltage) continue;
      const auto number = static_cast<std::size_t>(spec.outputs[i].number);
      cv.routes_.push_back({patch, i, number - 1});
      channels = std::max(channels, number);
    }
    for (std::size_t i = 0; i < spec.place_events.size(); ++i) {
      const engine::PlaceEventSpec& event = spec.place_events[i];
      if (event.kind != engine::PlaceEventSpec::Kind::voltage) continue;
      const auto number = static_cast<std::size_t>(event.voltage_channel);
      cv.gates_.push_back({patch, i, number - 1, event.volts, false});
      channels = std::max(channels, number);
    }
  }
  for (std::size_t c = 0; c < channels; ++c) {
    auto output = engine::VoltageOutput::create(config, static_cast<int>(c) + 1);
    if (!output) return output.error();
    cv.outputs_.push_back(std::move(*output));
  }
  cv.volts_.resize(channels);
  return cv;
}

/// What gates add to their channels; messages hold from their sample on.
void CvPlayer::add_gates(std::int64_t first, std::size_t n) KNOTWAVE_RT {
  for (std::size_t patch = 0; patch < players_.size(); ++patch) {
    std::size_t done = 0;
    const auto fill_to = [&](std::size_t end) {
      for (const Gate& gate : gates_) {
        if (gate.patch != patch || !gate.is_open) continue;
        for (std::size_t i = done; i < end; ++i) volts_[gate.channel][i] += gate.volts;
      }
      done = std::max(done, end);
    };
    for (const engine::PlayerMessage& message : players_.player(patch).take_messages()) {
      if (message.kind != engine::PlayerMessage::Kind::place_gate) continue;
      const std::int64_t at = base::first_sample(message.midi.time) - first;
      fill_to(
          static_cast<std::size_t>(std::clamp<std::int64_t>(at, 0, static_cast<std::int64_t>(n))));
      for (Gate& gate : gates_) {
        const bool is_meant =
            gate.patch == patch && static_cast<int>(gate.event) == message.place_event;
        if (is_meant) gate.is_open = message.midi.bytes[2] != 0;
      }
    }
    fill_to(n);
  }
}

void CvPlayer::render(std::size_t n, std::span<float* const> out) KNOTWAVE_RT {
  const std::int64_t first = players_.now();
  players_.render(n);
  for (auto& volts : volts_) volts.fill(0);
  for (const Route& route : routes_) {
    const std::span<const double> values = players_.values(route.patch, route.output);
    for (std::size_t i = 0; i < n; ++i) volts_[route.channel][i] += values[i];
  }
  add_gates(first, n);
  for (std::size_t c = 0; c < outputs_.size(); ++c) {
    outputs_[c].render(first, std::span<const double>(volts_[c]).first(n), {out[c], n});
  }
}

void CvPlayer::ramp_out() KNOTWAVE_RT {
  for (std::size_t patch = 0; patch < players_.size(); ++patch)
    players_.player(patch).release_all();
  for (engine::VoltageOutput& output : outputs_) output.ramp_out(now());
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
