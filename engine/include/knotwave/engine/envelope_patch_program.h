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

    /// The number, unrounded, within low..high; NaN gives `rest`. [audio]
    double value(double source, curves::CurveCursor& cursor) const KNOTWAVE_RT;
  };

  /// [control] Errors: those of PatchProgram::create(), unknown_name (a source, curve or port
  /// nobody has), value_out_of_range, unsupported (more channels of notes than there are: polyphony
  /// above 15 with NoteOutput::mpe).
  static Result<std::unique_ptr<const EnvelopePatchProgram>> create(const EnvelopePatchSpec& spec);

  const EnvelopePatchSpec& spec() const KNOTWAVE_RT { return spec_; }
  /// Envelopes, LFOs, maps.
  const PatchProgram& patch() const KNOTWAVE_RT { return *patch_; }
  std::span<const Output> outputs() const KNOTWAVE_RT { return outputs_; }
  /// Lines worth telling. [control]
  const std::vector<std::string>& report() const { return patch_->report(); }

 private:
  EnvelopePatchProgram() = default;
  EnvelopePatchSpec spec_;
  std::unique_ptr<const PatchProgram> patch_;
  std::vector<Output> outputs_;
};

}  // namespace knotwave::engine
