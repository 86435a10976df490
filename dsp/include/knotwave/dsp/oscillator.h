// SPDX-License-Identifier: MIT
// Plays WaveTables alias-free at any pitch. [audio] but for what is marked.
#pragma once
#include <cstdint>
#include <span>

#include "knotwave/base/time.h"
#include "knotwave/dsp/wave_tables.h"

namespace knotwave::dsp {

/// One voice's oscillator. Its only state is the phase and the level fade, so any split into blocks
/// gives the same samples. It may be given other tables at any sample.
class TableOscillator {
 public:
  static constexpr int kLevelFadeSamples = 128;

  /// Begins at `phase` at sub-sample time: `lead_samples` in [0, 1) is how long before the first
  /// sample the note began (clamped, NaN = 0); the first increment given to render() is used for
  /// it. [audio]
  void start(base::Phase phase, double lead_samples) KNOTWAVE_RT;

  /// out_left/out_right [n]; increments [n]: the phase step after each sample, above half a cycle
  /// it counts as backwards; positions [n] along v in 0..1, or empty for 0; phase_offset [n] in
  /// cycles (phase modulation; not finite = 0), or empty. Mono tables give both channels the same;
  /// out_right may be empty, then only the left is made. [audio] Cost: 3 ns a sample and channel,
  /// twice that during the 128 samples after the pitch crosses a level; bench/oscillator_bench.cpp.
  void render(const WaveTables& tables, std::span<const base::Phase> increments,
              std::span<const float> positions, std::span<const float> phase_offset,
              std::span<float> out_left, std::span<float> out_right) KNOTWAVE_RT;

  base::Phase phase() const KNOTWAVE_RT { return phase_; }

 private:
  struct Chunk;
  int steady_run(const WaveTables& tables, std::span<const base::Phase> increments) KNOTWAVE_RT;
  void render_chunk(const WaveTables& tables, const Chunk& chunk) KNOTWAVE_RT;

  base::Phase phase_;
  std::uint32_t lead_ = 0;  ///< in 2^-32 sample
  bool fresh_ = true;
  int level_ = 0;       ///< heard
  int next_level_ = 0;  ///< fading in while fade_left_ > 0
  int fade_left_ = 0;
};

}  // namespace knotwave::dsp
