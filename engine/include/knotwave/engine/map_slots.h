// SPDX-License-Identifier: MIT
// The places maps add to, as one flat table.
#pragma once
#include "knotwave/engine/patch.h"

namespace knotwave::engine {

inline constexpr int kMaxSources = kMaxOscillators + 1;  ///< the noise is the last
inline constexpr int kNoiseSource = kMaxOscillators;
inline constexpr int kMaxVoiceEnvelopes = kMaxEnvelopes + 1;  ///< one may be the built-in amp

/// First slot of each group; an oscillator, LFO, envelope or moved number adds its index.
inline constexpr int kSlotAmp = 0;
inline constexpr int kSlotGain = kSlotAmp + 1;
inline constexpr int kSlotPitch = kSlotGain + 1;
inline constexpr int kSlotPan = kSlotPitch + 1;
inline constexpr int kSlotCutoff = kSlotPan + 1;
inline constexpr int kSlotResonance = kSlotCutoff + 1;
inline constexpr int kSlotDrive = kSlotResonance + 1;
inline constexpr int kSlotCrossfade = kSlotDrive + 1;
inline constexpr int kSlotSourceLevel = kSlotCrossfade + 1;
inline constexpr int kSlotSourceGain = kSlotSourceLevel + kMaxSources;
inline constexpr int kSlotSourcePitch = kSlotSourceGain + kMaxSources;
inline constexpr int kSlotSourcePan = kSlotSourcePitch + kMaxSources;
inline constexpr int kSlotSourcePhase = kSlotSourcePan + kMaxSources;
inline constexpr int kSlotSourcePosition = kSlotSourcePhase + kMaxSources;
inline constexpr int kSlotLfoRate = kSlotSourcePosition + kMaxSources;
inline constexpr int kSlotEnvelopeTime = kSlotLfoRate + kMaxLfos;
inline constexpr int kSlotFree = kSlotEnvelopeTime + kMaxVoiceEnvelopes;
inline constexpr int kSlotControl = kSlotFree + kMaxFreeNumbers;
inline constexpr int kSlotCount = kSlotControl + kMaxMaps;

/// Where a target's value goes. `index` as MapSpec::target_index; for curve targets
/// the number of the moved number. [any]
constexpr int slot_of(MapTarget target, int index) KNOTWAVE_RT {
  switch (target) {
    case MapTarget::amp:
      return kSlotAmp;
    case MapTarget::level:
      return kSlotSourceLevel + index;
    case MapTarget::gain:
      return index < 0 ? kSlotGain : kSlotSourceGain + index;
    case MapTarget::pitch:
      return index < 0 ? kSlotPitch : kSlotSourcePitch + index;
    case MapTarget::pan:
      return index < 0 ? kSlotPan : kSlotSourcePan + index;
    case MapTarget::phase:
      return kSlotSourcePhase + index;
    case MapTarget::position:
      return kSlotSourcePosition + index;
    case MapTarget::cutoff:
      return kSlotCutoff;
    case MapTarget::resonance:
      return kSlotResonance;
    case MapTarget::drive:
      return kSlotDrive;
    case MapTarget::crossfade:
      return kSlotCrossfade;
    case MapTarget::lfo_rate:
      return kSlotLfoRate + index;
    case MapTarget::envelope_time:
      return kSlotEnvelopeTime + index;
    case MapTarget::free_number:
      return kSlotFree + index;
    case MapTarget::curve_weight:
    case MapTarget::curve_point:
    case MapTarget::curve_knot:
      return kSlotControl + index;
  }
  return kSlotAmp;
}

constexpr bool is_free_slot(int slot) KNOTWAVE_RT {
  return slot >= kSlotFree && slot < kSlotFree + kMaxFreeNumbers;
}

}  // namespace knotwave::engine
