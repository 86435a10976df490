// SPDX-License-Identifier: MIT
// Tunings: Scala .scl scales and .kbm keyboard mappings. [control] to make, [any] to read.
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "knotwave/base/result.h"
#include "knotwave/base/rt.h"

namespace knotwave::engine {

/// Frequency of every MIDI note. Fractional notes interpolate the pitch linearly in semitones.
class Tuning {
 public:
  Tuning();  ///< twelve-tone equal temperament, A4 = 440 Hz

  /// Either text may be empty (12-TET; the linear mapping with middle C and A4 = 440). Errors with
  /// line: malformed, value_out_of_range, unsupported.
  static Result<Tuning> create(std::string_view scl_text, std::string_view scl_name,
                               std::string_view kbm_text, std::string_view kbm_name);

  /// log2(frequency / 1 Hz) * 12 of a note, in semitones. A note the mapping leaves silent sounds
  /// as its neighbour below. [audio]
  double pitch_semitones(double note) const KNOTWAVE_RT;
  /// Frequency of a note. [audio]
  double hz(double note) const KNOTWAVE_RT;
  bool is_mapped(int note) const KNOTWAVE_RT;

 private:
  std::array<double, 128> pitch_;
  std::array<bool, 128> mapped_;
};

}  // namespace knotwave::engine
