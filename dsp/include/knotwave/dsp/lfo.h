// SPDX-License-Identifier: MIT
// Any curve as a low-frequency oscillator: free, key- or tempo-synced, one shot, or seeded random.
#pragma once
#include <cstdint>
#include <span>

#include "knotwave/base/random.h"
#include "knotwave/base/time.h"
#include "knotwave/curves/curve_program.h"

namespace knotwave::dsp {

struct LfoSpec {
  enum class Mode { free, key, one_shot } mode = Mode::key;
  double rate_hz = 5;       ///< cycles a second, when beats == 0
  double beats = 0;         ///< cycle length in quarter notes of the tempo map; 0 = use rate_hz
  double phase_cycles = 0;  ///< where it starts
  double delay_s = 0;       ///< silence (value of the start) before it begins, key and one_shot
  double fade_s = 0;        ///< depth rises along an S-curve from 0 to 1 after the delay
  bool random = false;      ///< a new seeded random level each cycle, glided along the curve 0..1
};

/// One LFO. Phase is an integer; free LFOs take theirs from engine time, so two voices agree.
class Lfo {
 public:
  /// [audio] `stream` is for LfoSpec::random.
  void start(const LfoSpec& spec, base::SampleTime time, double rate_hz,
             base::RandomStream stream) KNOTWAVE_RT;

  /// Values at samples first.. of engine time. `cycle` is the curve over one cycle (any domain,
  /// read from its start to its end). rate_factor [n] multiplies the speed, or empty. `tempo_beats`
  /// [n] is the song position in quarter notes at each sample, used when spec.beats > 0 (else
  /// empty). [audio]
  void render(const LfoSpec& spec, const curves::CurveProgram& cycle, std::int64_t first,
              std::span<const double> rate_factor, std::span<const double> tempo_beats,
              std::span<double> out) KNOTWAVE_RT;

 private:
  base::SampleTime start_;
  double sample_rate_hz_ = 48000;
  base::RandomStream stream_;
  std::uint64_t phase_ = 0;
  std::uint64_t cycles_ = 0;
  bool fresh_ = true;
  curves::CurveCursor cursor_;
};

}  // namespace knotwave::dsp
