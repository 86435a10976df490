// SPDX-License-Identifier: MIT
#include "voice_slots.h"

#include <algorithm>
#include <tuple>

namespace knotwave::engine {
namespace {

/// Smaller goes first.
auto steal_order(const VoiceSlot& slot) KNOTWAVE_RT {
  const int held = slot.key_down ? 2 : slot.pedal_held ? 1 : 0;
  return std::tuple(held, held == 0 ? slot.level : 0.0, slot.age);
}

}  // namespace

void VoiceSlots::clear() KNOTWAVE_RT { std::fill(slots_.begin(), slots_.end(), VoiceSlot{}); }

int VoiceSlots::sounding_count() const KNOTWAVE_RT {
  return static_cast<int>(std::count_if(slots_.begin(), slots_.end(),
                                        [](const VoiceSlot& slot) { return slot.is_sounding(); }));
}

int VoiceSlots::sounding_count(int bus, const PatchProgram* patch) const KNOTWAVE_RT {
  return static_cast<int>(std::count_if(slots_.begin(), slots_.end(), [&](const VoiceSlot& slot) {
    return slot.is_sounding() && slot.bus == bus && slot.patch == patch;
  }));
}

int VoiceSlots::free_place() const KNOTWAVE_RT {
  const auto found = std::find_if(slots_.begin(), slots_.end(), [](const VoiceSlot& slot) {
    return slot.state == VoiceSlot::State::free;
  });
  return found == slots_.end() ? -1 : static_cast<int>(found - slots_.begin());
}

std::uint32_t VoiceSlots::sounding_buses() const KNOTWAVE_RT {
  std::uint32_t buses = 0;
  for (const VoiceSlot& slot : slots_) {
    if (slot.state != VoiceSlot::State::free) buses |= 1u << slot.bus;
  }
  return buses;
}

bool VoiceSlots::is_playing(const BankProgram* bank) const KNOTWAVE_RT {
  return std::any_of(slots_.begin(), slots_.end(), [&](const VoiceSlot& slot) {
    return slot.state != VoiceSlot::State::free && slot.bank == bank;
  });
}

template <class Meant>
int VoiceSlots::oldest(Meant is_meant) const KNOTWAVE_RT {
  int best = -1;
  for (int i = 0; i < static_cast<int>(slots_.size()); ++i) {
    const VoiceSlot& slot = at(i);
    if (!slot.is_sounding() || slot.is_mono || !slot.key_down || !is_meant(slot)) continue;
    if (best < 0 || slot.age < at(best).age) best = i;
  }
  return best;
}

int VoiceSlots::victim(int bus, const PatchProgram* patch) const KNOTWAVE_RT {
  int best = -1;
  for (int i = 0; i < static_cast<int>(slots_.size()); ++i) {
    const VoiceSlot& slot = at(i);
    if (!slot.is_sounding()) continue;
    if (patch != nullptr && (slot.patch != patch || slot.bus != bus)) continue;
    if (best < 0 || steal_order(slot) < steal_order(at(best))) best = i;
  }
  return best;
}

int VoiceSlots::oldest_down(int channel, int key) const KNOTWAVE_RT {
  return oldest([&](const VoiceSlot& slot) { return slot.channel == channel && slot.key == key; });
}

int VoiceSlots::down(std::int32_t number, int channel, int key) const KNOTWAVE_RT {
  const int numbered = oldest([&](const VoiceSlot& slot) { return slot.number == number; });
  if (numbered >= 0) return numbered;
  return oldest([&](const VoiceSlot& slot) {
    return slot.number == Event::kNoNote && slot.channel == channel && slot.key == key;
  });
}

}  // namespace knotwave::engine
