// SPDX-License-Identifier: MIT
// What a host may automate: a table for each plugin (plugin.h), from which every format and the
// page docs/plugin-parameters.md are made. [any]
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/base/rt.h"

namespace knotwave::plugins {

/// Place in the table and symbol stay for ever: hosts keep them in sessions. New ones come at the
/// end (tests/plugins/parameters.txt).
struct Parameter {
  std::uint32_t id = 0;   ///< of `symbol` (FNV-1a, 31 bits): for formats that number as they like
  std::string word;       ///< as state and pages have it: "oscillator.1.level"
  std::string symbol;     ///< the same in letters, digits and underscores
  std::string name;       ///< "Oscillator 1 level"
  std::string group;      ///< "Oscillator 1"
  std::string_view unit;  ///< "dB", "semitones", "octaves", "cycles"; "" none
  double low = 0, high = 0;
  double initial = 0;
  std::vector<std::string> choices =
      {};        ///< of whole numbers from 0; none: any number of the range
  int slot = 0;  ///< of the instrument (engine/map_slots.h)
};

class ParameterTable {
 public:
  /// Symbols and ids are made of words.
  explicit ParameterTable(std::vector<Parameter> all);

  std::span<const Parameter> all() const KNOTWAVE_RT { return all_; }
  std::size_t size() const KNOTWAVE_RT { return all_.size(); }
  const Parameter& operator[](std::size_t place) const KNOTWAVE_RT { return all_[place]; }
  /// Its place; size(): there is none. Cost log2(size).
  std::size_t of_id(std::uint32_t id) const KNOTWAVE_RT;
  std::size_t of_word(std::string_view word) const;

 private:
  std::vector<Parameter> all_;
  std::vector<std::pair<std::uint32_t, std::size_t>> by_id_;
};

/// Within its range, of choices the nearest; NaN: its initial value.
double held(const Parameter& parameter, double value) KNOTWAVE_RT;
/// "-6.25 dB": as few digits as tell it within 0.001, at most three after the point; "Soft": of
/// choices its word.
std::string parameter_text(const Parameter& parameter, double value);
/// A choice's word, or a number with or without the unit, in any range (held within the parameter's
/// own). Errors: wrong_type.
Result<double> parameter_value(const Parameter& parameter, std::string_view text);

}  // namespace knotwave::plugins
