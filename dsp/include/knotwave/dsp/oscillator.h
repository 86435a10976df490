// SPDX-License-Identifier: MIT
// Plays WaveTables alias-free at any pitch. [audio] but for what is marked.
#pragma once
#include <cstdint>
#include <span>

#include "knotwave/base/time.h"
#include "knotwave/dsp/wave_tables.h"

namespace knotwave::dsp {

/// One voice's oscillator. Its only state is the phase and the level fade, so any split into blocks
/// gives the same samples.
class TableOscillator {
 public:
  static constexpr int kLevelFadeSamples = 128;

  /// Begins at `phase` at sub-sample time: `lead_samples` in [0, 1) is how long before the first
  /// sample the note began; the first increment given to render() is used for it. [audio]
  void start(base::Phase phase, double lead_samples) KNOTWAVE_RT;

  /// out_left/out_right [n]; increments [n]: the phase step after each sample; positions [n] along
  /// v in 0..1, or empty for 0; phase_offset [n] in cycles (phase modulation), or empty. Mono
  /// tables give both channels the same. [audio]
  void render(const WaveTables& tables, std::span<const base::Phase> increments,
              std::span<const float> positions, std::span<const float> phase_offset,
              std::span<float> out_left, std::span<float> out_right) KNOTWAVE_RT;

  base::Phase phase() const KNOTWAVE_RT { return phase_; }

 private:
  base::Phase phase_;
  double lead_samples_ = 0;
  bool fresh_ = true;
  int level_ = 0, next_level_ = 0, fade_left_ = 0;
};

}  // namespace knotwave::dsp
