// SPDX-License-Identifier: MIT
// The places maps add to, as one flat table.
#pragma once
#include "knotwave/engine/patch.h"

namespace knotwave::engine {

inline constexpr int kMaxSources = kMaxOscillators + 1;  ///< the noise is the last
inline constexpr int kNoiseSource = kMaxOscillators;
inline constexpr int kMaxVoiceEnvelopes = kMaxEnvelopes + 1;  ///< one may be the built-in amp

/// First slot of each group; an oscillator, LFO, envelope or moved number adds its index.
enum Slot : int {
  kSlotAmp = 0,
  kSlotGain,
  kSlotPitch,
  kSlotPan,
  kSlotCutoff,
  kSlotResonance,
  kSlotDrive,
  kSlotCrossfade,
  kSlotSourceLevel,
  kSlotSourceGain = kSlotSourceLevel + kMaxSources,
  kSlotSourcePitch = kSlotSourceGain + kMaxSources,
  kSlotSourcePan = kSlotSourcePitch + kMaxSources,
  kSlotSourcePhase = kSlotSourcePan + kMaxSources,
  kSlotSourcePosition = kSlotSourcePhase + kMaxSources,
  kSlotLfoRate = kSlotSourcePosition + kMaxSources,
  kSlotEnvelopeTime = kSlotLfoRate + kMaxLfos,
  kSlotControl = kSlotEnvelopeTime + kMaxVoiceEnvelopes,
  kSlotCount = kSlotControl + kMaxMaps,
};

/// Where a target's value goes. `index` as MapSpec::target_index; for curve_weight and curve_point
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
    case MapTarget::curve_weight:
    case MapTarget::curve_point:
      return kSlotControl + index;
  }
  return kSlotAmp;
}

}  // namespace knotwave::engine
