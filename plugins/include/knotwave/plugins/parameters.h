// SPDX-License-Identifier: MIT
// What a host may automate on the instrument: one table, from which every plugin format and the
// page docs/plugin-parameters.md are made. A parameter adds to a slot of every voice
// (engine/map_slots.h), beside what the patch and its maps say; at its initial value it adds
// nothing, so a plugin nobody touched sounds as knotwave-render. [any]
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "knotwave/base/result.h"

namespace knotwave::plugins {

/// Place in the table and symbol stay for ever: hosts keep them in sessions. New ones come at the
/// end (tests/plugins/parameters.txt).
struct Parameter {
  std::uint32_t id = 0;   ///< of `symbol` (FNV-1a, 31 bits): for formats that number as they like
  std::string word;       ///< as engine::slot_word(): "oscillator.1.level"
  std::string symbol;     ///< the same in letters, digits and underscores
  std::string name;       ///< "Oscillator 1 level"
  std::string group;      ///< "Oscillator 1"
  std::string_view unit;  ///< "dB", "semitones", "octaves", "cycles"; "" none
  double low = 0, high = 0;
  double initial = 0;
  int slot = 0;
};

/// All of them, in the order in which formats number them.
std::span<const Parameter> parameters();
/// Its place by id or by word; parameters().size(): there is none.
std::size_t parameter_of_id(std::uint32_t id);
std::size_t parameter_of_word(std::string_view word);

/// "-6.25 dB": as few digits as tell it within 0.001, at most three after the point.
std::string parameter_text(const Parameter& parameter, double value);
/// A number with or without the unit, in any range (held within the parameter's own). Errors:
/// wrong_type.
Result<double> parameter_value(const Parameter& parameter, std::string_view text);

}  // namespace knotwave::plugins
