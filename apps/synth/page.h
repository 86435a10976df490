// SPDX-License-Identifier: MIT
// What a person sees at a glance: a status becomes lines of text. Knows no terminal.
#pragma once
#include <string>
#include <vector>

#include "status.h"

namespace knotwave::synth {

struct PageSize {
  int columns = 80, rows = 24;
  friend bool operator==(const PageSize&, const PageSize&) = default;
};

struct PageLine {
  enum class Style { plain, title, dim, good, warning, alarm };
  std::string text;  ///< UTF-8, no control characters
  Style style = Style::plain;
  friend bool operator==(const PageLine&, const PageLine&) = default;
};

/// At most `size.rows` lines of at most `size.columns` characters. A small window loses the curve
/// first, then messages.
std::vector<PageLine> page(const SynthStatus& status, PageSize size);

/// A bar from -60 to 0 dBFS, full where the samples were beyond.
std::string meter(double level_dbfs, int columns);

/// A line with the style as the terminal is told it (ECMA-48 SGR), or without any.
std::string terminal_text(const PageLine& line, bool has_colour);

}  // namespace knotwave::synth
