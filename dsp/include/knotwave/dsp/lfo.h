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
  /// free: the phase runs from engine time 0 (with beats: from song position 0), so all voices
  /// agree. key: it starts with the note. one_shot: like key, one cycle, then the curve's end
  /// holds.
  enum class Mode { free, key, one_shot } mode = Mode::key;
  double rate_hz = 5;       ///< cycles a second, when beats == 0; 0 .. half the sample rate
  double beats = 0;         ///< cycle length in quarter notes of the tempo map; 0 = use rate_hz
  double phase_cycles = 0;  ///< where it starts
  double delay_s = 0;       ///< key and one_shot wait that long at the value of their start
  double fade_s = 0;        ///< > 0: the output is 0 until the delay is over and its depth then
                            ///< rises along the S-curve 3 t^2 - 2 t^3, in every mode
  bool random = false;      ///< a new seeded random level -1..1 each cycle, glided along the curve
                            ///< (0..1); as the cycle's number decides, free ones still agree
};

/// One LFO. The position is an integer: whole cycles and 64 bits of phase. It is a function of
/// time, plus what rate_factor has added so far, so it is the same for any block size. Blocks are
/// rendered in order; samples left out count at the plain rate.
class Lfo {
 public:
  /// [audio] `stream` is for LfoSpec::random.
  void start(const LfoSpec& spec, base::SampleTime time, double rate_hz,
             base::RandomStream stream) KNOTWAVE_RT;

  /// Values at samples first.. of engine time, none before the start. `cycle` is the curve over one
  /// cycle (any domain, read from its start to its end). rate_factor [n] multiplies the speed, or
  /// empty. `tempo_beats` [n] is the song position in quarter notes at each sample (for a
  /// key-synced LFO those played so far, which never jump), used when spec.beats > 0 (else, or
  /// without it, rate_hz counts); a key-synced LFO then starts on a whole sample. NaN in either
  /// stands still. [audio]
  void render(const LfoSpec& spec, const curves::CurveProgram& cycle, std::int64_t first,
              std::span<const double> rate_factor, std::span<const double> tempo_beats,
              std::span<double> out) KNOTWAVE_RT {
    render(spec, cycle, first, rate_factor, tempo_beats, {}, out);
  }
  /// The same where control k of the cycle moves every sample by controls[k][i]; none: at rest.
  /// [audio]
  void render(const LfoSpec& spec, const curves::CurveProgram& cycle, std::int64_t first,
              std::span<const double> rate_factor, std::span<const double> tempo_beats,
              std::span<const double* const> controls, std::span<double> out) KNOTWAVE_RT;

  /// The song position jumps before the next sample rendered: that alone says where the LFO is, and
  /// what rate_factor has added is over. [audio]
  void song_moved() KNOTWAVE_RT {
    extra_ = {};
    has_beats_ = false;
  }

 private:
  /// 128 bits: whole cycles and the phase within one, modulo 2^64 cycles.
  struct Position {
    std::uint64_t cycle = 0;
    std::uint64_t phase = 0;
  };
  static Position sum(Position a, Position b) KNOTWAVE_RT;
  static Position difference(Position a, Position b) KNOTWAVE_RT;
  static Position from_cycles(double cycles) KNOTWAVE_RT;

  struct Chunk;
  void place_each(const LfoSpec& spec, const curves::CurveProgram& cycle, std::int64_t first,
                  Chunk& chunk) KNOTWAVE_RT;
  void draw_each(Position position, Chunk& chunk) KNOTWAVE_RT;
  Position at_sample(std::int64_t sample) const KNOTWAVE_RT;
  Position at_beats(const LfoSpec& spec, std::int64_t sample, double beats) KNOTWAVE_RT;
  Position in_time(const LfoSpec& spec, std::int64_t sample, double factor,
                   Position plain) KNOTWAVE_RT;
  Position in_song(const LfoSpec& spec, std::int64_t sample, double factor,
                   double beats) KNOTWAVE_RT;
  double depth(const LfoSpec& spec, std::int64_t sample) const KNOTWAVE_RT;
  void draw_levels(std::uint64_t cycle) KNOTWAVE_RT;

  double sample_rate_hz_ = 48000;
  std::uint64_t increment_ = 0;  ///< of phase a sample at spec.rate_hz
  std::uint64_t first_phase_ = 0;
  base::SampleTime phase_start_;  ///< when the phase begins to run
  base::SampleTime fade_start_;
  Position extra_;  ///< what rate_factor added
  double last_beats_ = 0;
  bool has_beats_ = false;
  double origin_beats_ = 0;  ///< song position at phase_start_
  bool has_origin_ = false;
  bool has_levels_ = false;
  std::uint64_t levels_of_ = 0;  ///< cycle that level_from_ and level_to_ belong to
  double level_from_ = 0, level_to_ = 0;
  base::RandomStream stream_;
  curves::CurveCursor cursor_;
};

}  // namespace knotwave::dsp
