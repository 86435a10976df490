// SPDX-License-Identifier: MIT
#include "knotwave/engine/voltage_mix.h"

#include <algorithm>

namespace knotwave::engine {

VoltageMix::VoltageMix(std::span<const EnvelopePatchProgram* const> patches)
    : done_(patches.size()) {
  std::size_t channels = 0;
  const auto place = [&channels](int number) {
    channels = std::max(channels, static_cast<std::size_t>(number));
    return static_cast<std::size_t>(number) - 1;
  };
  for (std::size_t patch = 0; patch < patches.size(); ++patch) {
    const EnvelopePatchSpec& spec = patches[patch]->spec();
    for (std::size_t i = 0; i < spec.outputs.size(); ++i) {
      if (spec.outputs[i].kind != OutputKind::voltage) continue;
      routes_.push_back({patch, i, place(spec.outputs[i].number)});
    }
    for (std::size_t i = 0; i < spec.place_events.size(); ++i) {
      const PlaceEventSpec& event = spec.place_events[i];
      if (event.kind != PlaceEventSpec::Kind::voltage) continue;
      gates_.push_back({patch, i, place(event.voltage_channel), event.volts, false});
    }
  }
  has_gates_ = !gates_.empty();
  volts_.resize(channels);
  gate_volts_.resize(channels);
}

void VoltageMix::begin(std::int64_t first, std::size_t n) KNOTWAVE_RT {
  first_ = first;
  n_ = n;
  for (std::size_t c = 0; has_gates_ && c < gate_volts_.size(); ++c) gate_volts_[c].fill(0);
  std::fill(done_.begin(), done_.end(), std::size_t{0});
}

void VoltageMix::fill_gates(std::size_t patch, std::size_t end) KNOTWAVE_RT {
  for (const Gate& gate : gates_) {
    if (gate.patch != patch || !gate.is_open) continue;
    for (std::size_t i = done_[patch]; i < end; ++i) gate_volts_[gate.channel][i] += gate.volts;
  }
  done_[patch] = std::max(done_[patch], end);
}

void VoltageMix::hear(std::size_t patch, const PlayerMessage& message) KNOTWAVE_RT {
  if (message.kind != PlayerMessage::Kind::place_gate) return;
  const std::int64_t at = base::first_sample(message.midi.time) - first_;
  fill_gates(patch, static_cast<std::size_t>(
                        std::clamp<std::int64_t>(at, 0, static_cast<std::int64_t>(n_))));
  for (Gate& gate : gates_) {
    const bool is_meant =
        gate.patch == patch && static_cast<int>(gate.event) == message.place_event;
    if (is_meant) gate.is_open = message.midi.bytes[2] != 0;
  }
}

}  // namespace knotwave::engine
