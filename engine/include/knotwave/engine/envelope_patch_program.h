// SPDX-License-Identifier: MIT
// A patch of the envelope generator compiled. Immutable, no sample rate in it.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "knotwave/curves/curve_program.h"
#include "knotwave/engine/envelope_patch.h"
#include "knotwave/engine/patch_program.h"

namespace knotwave::engine {

class EnvelopePatchProgram {
 public:
  /// An output's way from a source's value to a number in its own unit.
  struct Output {
    OutputSpec spec;
    std::optional<curves::CurveProgram> curve;

    /// The number, unrounded, within low..high; exactly these at the ends of `of` (with a curve:
    /// where that is 0 and 1). NaN gives `rest`. [audio]
    double value(double source, curves::CurveCursor& cursor) const KNOTWAVE_RT;
    /// out[i] = value(source[i]) to the bit; [n] each. [audio]
    void values(std::span<const double> source, std::span<double> out,
                curves::CurveCursor& cursor) const KNOTWAVE_RT;
  };

  /// [control] Errors: those of PatchProgram::create(), unknown_name (a source, curve or port
  /// nobody has), value_out_of_range (also an output's curve that does not run from 0 to 1),
  /// unsupported (more channels of notes than there are: polyphony above 15 with NoteOutput::mpe;
  /// an output's curve that a map moves).
  static Result<std::unique_ptr<const EnvelopePatchProgram>> create(const EnvelopePatchSpec& spec);

  const EnvelopePatchSpec& spec() const KNOTWAVE_RT { return spec_; }
  /// Envelopes, LFOs, maps.
  const PatchProgram& patch() const KNOTWAVE_RT { return *patch_; }
  std::span<const Output> outputs() const KNOTWAVE_RT { return outputs_; }
  /// An LFO moves an output, itself or through maps: its voices never stand still.
  bool hears_lfo() const KNOTWAVE_RT { return hears_lfo_; }
  /// Lines worth telling. [control]
  const std::vector<std::string>& report() const { return patch_->report(); }

 private:
  EnvelopePatchProgram() = default;
  EnvelopePatchSpec spec_;
  std::unique_ptr<const PatchProgram> patch_;
  std::vector<Output> outputs_;
  bool hears_lfo_ = false;
};

}  // namespace knotwave::engine
