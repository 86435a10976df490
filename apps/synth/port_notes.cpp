// SPDX-License-Identifier: MIT
#include "port_notes.h"

namespace knotwave::synth {

void PortNotes::heard(const base::MidiEvent& event) noexcept {
  const int channel = event.channel(), first = event.bytes[1] & 127;
  const std::uint8_t second = event.bytes[2];
  const auto status = event.status();
  if (status == base::MidiStatus::note_on || status == base::MidiStatus::note_off) {
    std::uint64_t& bits = half(channel, first);
    const std::uint64_t bit = std::uint64_t{1} << (first & 63);
    const bool is_on = status == base::MidiStatus::note_on && second > 0;
    bits = is_on ? bits | bit : bits & ~bit;
  }
  if (status != base::MidiStatus::control_change) return;
  for (std::size_t i = 0; i < kPedals.size(); ++i) {
    if (first != kPedals[i]) continue;
    std::uint64_t& bits = pedals_[static_cast<std::size_t>(channel)];
    const std::uint64_t bit = std::uint64_t{1} << i;
    bits = second >= 64 ? bits | bit : bits & ~bit;
  }
}

}  // namespace knotwave::synth
