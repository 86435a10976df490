// SPDX-License-Identifier: MIT
// Any curve as an envelope: loop, sustain and release knots, joins that move control points.
// docs/envelopes.md has the formulas and pictures.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "knotwave/base/time.h"
#include "knotwave/curves/compile.h"

namespace knotwave::dsp {

/// What a patch says of an envelope. Places are parameters of the compiled function: u for a 1-D
/// curve, x for a 2-D one.
struct EnvelopeSpec {
  curves::CompileOptions compile;
  double seconds = 1;     ///< length of the whole domain; of one unit of x for a 2-D curve
  double sustain_u = -1;  ///< hold here while the gate is open; < u_min: none
  double loop_start_u = 0, loop_end_u = 0;  ///< repeat while the gate is open; equal: none
  double release_u = -1;  ///< gate closed: go on from here, joined; < u_min: from the sustain
                          ///< place, or the loop's end, or run on (one shot) without either
  enum class Retrigger { restart, current } retrigger = Retrigger::current;
};

/// Immutable, shared by voices: the program and its joins.
class EnvelopeProgram {
 public:
  /// [control] Errors: those of compile_function and compile_join; value_out_of_range (seconds not
  /// above 0); parameter_out_of_range (places outside the domain or out of order: start <= loop
  /// start < loop end <= release, sustain <= release; sustain and loop together); not_scalar.
  static Result<EnvelopeProgram> create(const curves::NurbsCurve& curve, const EnvelopeSpec& spec);

  const curves::CurveProgram& program() const KNOTWAVE_RT { return program_; }
  const EnvelopeSpec& spec() const KNOTWAVE_RT { return spec_; }
  const curves::JoinProgram& start_join() const KNOTWAVE_RT { return start_join_; }
  /// Only with has_release().
  const curves::JoinProgram& release_join() const KNOTWAVE_RT { return release_join_; }
  /// A section is left to play when the gate closes; without, the curve runs on to its end.
  bool has_release() const KNOTWAVE_RT { return has_release_; }
  bool has_sustain() const KNOTWAVE_RT { return spec_.sustain_u >= program_.u_min(); }
  bool has_loop() const KNOTWAVE_RT { return spec_.loop_end_u > spec_.loop_start_u; }
  double u_per_second() const KNOTWAVE_RT { return u_per_second_; }
  double end_value() const KNOTWAVE_RT { return end_value_; }  ///< what it rests at

 private:
  EnvelopeSpec spec_;
  curves::CurveProgram program_;
  curves::JoinProgram start_join_, release_join_;
  double u_per_second_ = 1;
  bool has_release_ = false;
  double end_value_ = 0;
};

/// One voice's envelope. Gate times carry a fraction of a sample; the value is a function of time:
///   y(n) = program(place) + dp0 B0(age) + dp1 B1(age) + brake(age),
/// where place and age run along u from the last gate, place wraps at the loop and stops at the
/// sustain knot. B0 and B1 belong to the join (curves/compile.h) and are exactly 0 once it is over.
/// The brake plays what slope the hull did not let P1 take, or degree 1 and 2 have no point for: it
/// is as long as the hull allows. Calls come in order of time; one program plays until the envelope
/// is idle or reset.
class Envelope {
 public:
  /// Opens the gate at `time`. From rest: plays the curve from its start. While sounding:
  /// Retrigger::current joins from the present value and slope (C0 always; C1 while controls stand
  /// still and the value is not on the hull's edge); restart jumps to the start. `time_scale`
  /// stretches the whole curve (velocity, key): clamped to 1e-4..1e4, NaN = 1. [audio]
  void gate_on(const EnvelopeProgram& program, base::SampleTime time, double rate_hz,
               double time_scale) KNOTWAVE_RT;
  /// Closes the gate at `time`: jumps to the release section, joined as above. Held exactly where
  /// that section starts, the curve goes on as drawn but for the corner, rounded over 10 ms or a
  /// 32nd of the section. [audio]
  void gate_off(const EnvelopeProgram& program, base::SampleTime time) KNOTWAVE_RT;
  /// Goes to rest at once. [audio]
  void reset() KNOTWAVE_RT { *this = {}; }

  /// Values at samples first..first+n-1 (engine time), none before the last gate. Control k moves
  /// every sample by controls[k][i]; pass none for rest values. [audio]
  void render(const EnvelopeProgram& program, std::int64_t first,
              std::span<const double* const> controls, std::span<double> out) KNOTWAVE_RT;

  /// The curve had come to its end (or was never started) by the last sample rendered. [audio]
  bool is_idle() const KNOTWAVE_RT { return stage_ == Stage::idle; }
  bool gate_is_open() const KNOTWAVE_RT { return stage_ == Stage::gate_open; }
  /// How far along the curve it is at `sample`, at or after the last one rendered: 0..1 of the
  /// domain. [audio]
  double place_at(const EnvelopeProgram& program, std::int64_t sample) const KNOTWAVE_RT;
  /// How far it has run since the last gate, at a time from then on: where it would be were there
  /// no sustain place, no loop and no end; and its step. For those who watch for places. [audio]
  double unfolded_u(base::SampleTime time) const KNOTWAVE_RT {
    return place_.u + (static_cast<double>(time.sample - place_.sample) +
                       static_cast<double>(time.fraction) * 0x1p-32) *
                          u_per_sample_;
  }
  double u_per_sample() const KNOTWAVE_RT { return u_per_sample_; }
  /// Times p1 was limited to the hull, and a brake played the rest of the slope. [audio]
  int limited_joins() const KNOTWAVE_RT { return limited_joins_; }

 private:
  enum class Stage : std::uint8_t { idle, gate_open, released };
  /// A place on the curve that moves with time: u(n) = u + (n - sample) per_sample.
  struct Run {
    std::int64_t sample = 0;
    double u = 0;
  };
  struct Now {
    double place_u = 0, value = 0;
    double slope_per_sample = 0;
    bool ended = true;
    bool held = false;  ///< at the sustain knot
    bool joining = false;
  };
  Now now(const EnvelopeProgram& program, base::SampleTime time) const KNOTWAVE_RT;
  void run_from(double u, base::SampleTime time) KNOTWAVE_RT;
  void join(const EnvelopeProgram& program, const curves::JoinProgram& section, const Now& from,
            base::SampleTime time) KNOTWAVE_RT;
  void let_go(const EnvelopeProgram& program, const Now& from, base::SampleTime time) KNOTWAVE_RT;
  void start(const curves::JoinProgram& section, base::SampleTime time) KNOTWAVE_RT;
  /// A section with its first point moved: what it starts with, and whether P1 is level with P0.
  struct Joined {
    const curves::JoinProgram& section;
    double value = 0, slope = 0;
    bool is_level = false;
  };
  void set_brake(const Joined& joined, double wanted, double longest) KNOTWAVE_RT;
  bool fits(const Joined& joined, double room, double length) const KNOTWAVE_RT;
  double rounded(double value, double x) const KNOTWAVE_RT;
  double place(const EnvelopeProgram& program, double u) const KNOTWAVE_RT;
  void render_chunk(const EnvelopeProgram& program, std::int64_t first,
                    std::span<const double* const> controls, std::size_t offset,
                    std::span<double> out) KNOTWAVE_RT;
  void add_join(const EnvelopeProgram& program, std::int64_t first,
                std::span<double> out) KNOTWAVE_RT;
  std::span<const double> last_controls(const EnvelopeProgram& program) const KNOTWAVE_RT;

  Stage stage_ = Stage::idle;
  Run place_, age_;
  double u_per_sample_ = 0;
  double rounding_u_ = 0;  ///< 10 ms
  const curves::JoinProgram* join_ = nullptr;
  curves::JoinProgram::Deltas deltas_;
  double brake_slope_ = 0, brake_u_ = 1;  ///< slope by u the hull left over, and how long it lasts
  int limited_joins_ = 0;
  bool controls_moved_ = false;  ///< last_controls_ holds what the last sample was rendered with
  std::array<double, curves::kMaxControls> last_controls_{};
  curves::CurveCursor cursor_, join_cursor_;
};

}  // namespace knotwave::dsp
