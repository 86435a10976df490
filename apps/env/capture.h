// SPDX-License-Identifier: MIT
// What a knob did, or how loud a sound is, as a curve of few points.
#pragma once
#include <atomic>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/curves/nurbs_curve.h"
#include "knotwave/engine/knob_line.h"
#include "knotwave/engine/knob_recorder.h"

#include "options.h"

namespace knotwave::env {

/// What was recorded, from time 0 on.
struct Recording {
  std::string what;        ///< "cc1 of channel 3"
  std::string scale;       ///< "0 to 127 is 0 to 1"
  engine::TimedLine line;  ///< in the unit of time asked for; values as the curve has them
  std::vector<engine::TimedStep> steps;  ///< a knob's, at the same times
  std::size_t count = 0;                 ///< values that came in
  double unit = 1;                       ///< what one unit of the tolerance is worth in values
  std::string unit_name;                 ///< "steps", "dB" or ""
  double usual_tolerance = 0.5;
  int last_step = 0;  ///< of a knob
};

/// A curve near a recording, as a file, and what is said of it.
struct Capture {
  curves::NurbsCurve curve;
  double tolerance = 0;  ///< asked for, in units
  double proved = 0;     ///< the same, from the recording's lines to the curve, everywhere
  double seen = 0;       ///< the largest at the points of the lines
  int steps_off = 0;     ///< of a knob: at its times the curve says another step, so many off
  std::string text;      ///< of the curve file
  std::string report;    ///< one line
};

/// Errors: those of reduce_data(); too_many_points (more than `--points`; the message has a
/// tolerance that would do, if there is one).
Result<Capture> reduce(const CaptureOptions& options, const std::string& output,
                       const Recording& recording);

/// Recorded lines, or steps, and the curve, as SVG.
std::string plot_of(const CaptureOptions& options, const Recording& recording,
                    const curves::NurbsCurve& curve);

/// How the times of moves are to be read.
struct MoveSpan {
  double end = 0;  ///< samples, with `whole`
  double samples_per_unit = 1;
  double ramp = 0.05;  ///< units
};
/// A knob's moves as a recording, from the first to the last; with `whole` from 0 to the end.
/// Errors: value_out_of_range (it never moved); too_few_points.
Result<Recording> recording_of(const CaptureOptions& options, const engine::KnobRecorder& recorder,
                               const MoveSpan& span);

/// Which values of MIDI there are, for those who ask for another.
class ValueList {
 public:
  void hear(const base::MidiEvent& event);
  /// "cc1 (ch 3), cc7 (ch 1, 2), bend (ch 3)", or "none".
  std::string text() const;

 private:
  struct Value {
    engine::MidiValueSpec spec;
    unsigned channels = 0;
  };
  std::vector<Value> values_;
};

/// From the file that the options name. Errors: those of the file; unknown_name (a MIDI file
/// without the value; the message has those that are there).
Result<Recording> record_midi_file(const EnvOptions& options);
Result<Recording> record_sound_file(const EnvOptions& options);
/// From MIDI inputs, until a signal or `duration_s`. Errors: those of MidiInputs::open();
/// unknown_name (the value did not come).
Result<Recording> record_midi_inputs(const EnvOptions& options, const std::atomic<int>& signals);

/// Records, reduces and writes; the text for standard output. A curve that goes there itself has
/// its report on standard error.
Result<std::string> run_capture(const EnvOptions& options, const std::atomic<int>& signals);

}  // namespace knotwave::env
