// SPDX-License-Identifier: MIT
// Tunings: Scala .scl scales and .kbm keyboard mappings; docs/tuning.md. [control] to make, [any]
// to read. Source of the formats: https://www.huygens-fokker.org/scala/scl_format.html and
// https://www.huygens-fokker.org/scala/help.htm#mappings
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "knotwave/base/result.h"
#include "knotwave/base/rt.h"

namespace knotwave::engine {

inline constexpr int kMaxScaleNotes = 4096;

/// Pitch of every MIDI note. Fractional notes interpolate between their neighbours' pitches; below
/// note 0 and above 127 pitch goes on in equal semitones. NaN counts as note 0.
class Tuning {
 public:
  Tuning();  ///< twelve-tone equal temperament, A4 = 440 Hz

  /// Either text may be empty: 12-TET; the linear mapping with scale degree 0 on note 60 and
  /// note 69 = 440 Hz. Notes outside the mapping's first..last stay in 12-TET. Errors with line and
  /// column: malformed, value_out_of_range (also a note more than 100 octaves from A4).
  static Result<Tuning> create(std::string_view scl_text, std::string_view scl_name,
                               std::string_view kbm_text, std::string_view kbm_name);

  /// Pitch of a note as the fractional note number of 12-TET that sounds the same: 69 + 12 log2(f /
  /// 440 Hz). Exactly `note` in 12-TET. A note the mapping leaves out sounds as its neighbour below
  /// (or above, where there is none). Error <= 2e-14 semitones a note. [audio]
  double midi_pitch(double note) const KNOTWAVE_RT;
  /// Frequency of a note, note_to_hz(midi_pitch(note)). [audio]
  double hz(double note) const KNOTWAVE_RT;
  /// Whether the mapping gives the note a pitch of its own; false outside 0..127. [audio]
  bool is_mapped(int note) const KNOTWAVE_RT;

 private:
  std::array<double, 128> pitch_;
  std::array<bool, 128> mapped_;
};

}  // namespace knotwave::engine
