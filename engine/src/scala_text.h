// SPDX-License-Identifier: MIT
// The words of .scl and .kbm files with their places. Private to tuning.cpp. [control]
#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "knotwave/base/result.h"

namespace knotwave::engine {

/// The first word of a line that is no comment.
struct ScalaLine {
  std::string_view word;  ///< empty on a blank line
  int line = 0;
  int column = 1;
};

/// The lines that do not begin with '!', in order; CR LF and a byte order mark are accepted.
std::vector<ScalaLine> scala_lines(std::string_view text);

/// A scale: pitches of degrees 1..n in semitones; the last is the interval of repetition.
struct Scale {
  std::vector<double> degrees;
  std::vector<ScalaLine> lines;  ///< where each is, for messages; none without a file

  /// Pitch of any degree in semitones from degree 0, repeating; 0 for a scale of no notes.
  double semitones(int degree) const;
};

/// A keyboard mapping as its file says it. Defaults are those of no file.
struct KeyboardMapping {
  int first_note = 0, last_note = 127;
  int middle_note = 60;
  int reference_note = 69;
  double reference_hz = 440;
  int octave_degree = 0;                    ///< the degree one pattern up, if there is a pattern
  std::vector<std::optional<int>> degrees;  ///< of the pattern's keys; empty = the linear mapping
  ScalaLine reference_line, hz_line;        ///< where the reference is, for messages

  /// Scale degree of a key and how many patterns above the middle note's it lies; none: unmapped.
  struct Place {
    int degree = 0;
    int pattern = 0;
  };
  std::optional<Place> place(int note) const;
};

/// Errors: malformed, value_out_of_range.
Result<Scale> parse_scale(std::string_view text, std::string_view source);
Result<KeyboardMapping> parse_mapping(std::string_view text, std::string_view source);

}  // namespace knotwave::engine
