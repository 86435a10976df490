// SPDX-License-Identifier: MIT
// Any curve as an envelope: loop, sustain and release knots, joins that move control points.
#pragma once
#include <span>
#include <vector>

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
  /// [control] Errors: those of compile_function and compile_join; parameter_out_of_range (places
  /// outside the domain or out of order: start <= loop start < loop end <= release); not_scalar.
  static Result<EnvelopeProgram> create(const curves::NurbsCurve& curve, const EnvelopeSpec& spec);

  const curves::CurveProgram& program() const KNOTWAVE_RT { return program_; }
  const EnvelopeSpec& spec() const KNOTWAVE_RT { return spec_; }
  const curves::JoinProgram& start_join() const KNOTWAVE_RT { return start_join_; }
  const curves::JoinProgram& release_join() const KNOTWAVE_RT { return release_join_; }
  bool has_release() const KNOTWAVE_RT { return has_release_; }
  double end_value() const KNOTWAVE_RT { return end_value_; }  ///< what it rests at

 private:
  EnvelopeSpec spec_;
  curves::CurveProgram program_;
  curves::JoinProgram start_join_, release_join_;
  bool has_release_ = false;
  double end_value_ = 0;
};

/// One voice's envelope. Gate times carry a fraction of a sample; the value is a function of time.
class Envelope {
 public:
  /// Opens the gate at `time`. From rest: plays the curve from its start. While sounding:
  /// Retrigger::current joins from the present value and slope (C0 always, C1 where the hull
  /// allows); restart jumps to the start. `time_scale` stretches the whole curve (velocity, key):
  /// clamped to 1e-4..1e4. [audio]
  void gate_on(const EnvelopeProgram& program, base::SampleTime time, double rate_hz,
               double time_scale) KNOTWAVE_RT;
  /// Closes the gate at `time`. [audio]
  void gate_off(const EnvelopeProgram& program, base::SampleTime time) KNOTWAVE_RT;
  /// Goes to rest at once. [audio]
  void reset() KNOTWAVE_RT;

  /// Values at samples first..first+n-1 (engine time). Control k moves every sample by
  /// controls[k][i]; pass none for rest values. [audio]
  void render(const EnvelopeProgram& program, std::int64_t first,
              std::span<const double* const> controls, std::span<double> out) KNOTWAVE_RT;

  /// The curve has come to its end (or was never started). [audio]
  bool is_idle() const KNOTWAVE_RT { return stage_ == Stage::idle; }
  bool gate_is_open() const KNOTWAVE_RT {
    return stage_ == Stage::gate_open || stage_ == Stage::holding;
  }
  /// Times p1 was limited to the hull, so that a join was C0. [audio]
  int limited_joins() const KNOTWAVE_RT { return limited_joins_; }

 private:
  enum class Stage { idle, gate_open, holding, released };
  Stage stage_ = Stage::idle;
  base::SampleTime origin_;  ///< when the curve was at origin_u_
  double origin_u_ = 0;
  double u_per_sample_ = 0;
  const curves::JoinProgram* join_ = nullptr;
  curves::JoinProgram::Deltas deltas_;
  double held_ = 0;
  int limited_joins_ = 0;
  curves::CurveCursor cursor_, join_cursor_;
};

}  // namespace knotwave::dsp
