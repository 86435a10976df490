// SPDX-License-Identifier: MIT
// Parameters as tables list them.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "knotwave/plugins/parameters.h"

namespace knotwave::plugins {

struct Range {
  double low = 0, high = 1, initial = 0;
};

inline Parameter number_parameter(std::string word, std::string name, std::string group,
                                  std::string_view unit, Range range) {
  Parameter parameter;
  parameter.word = std::move(word);
  parameter.name = std::move(name);
  parameter.group = std::move(group);
  parameter.unit = unit;
  parameter.low = range.low;
  parameter.high = range.high;
  parameter.initial = range.initial;
  return parameter;
}

inline Parameter choice_parameter(std::string word, std::string name, std::string group,
                                  std::vector<std::string> choices, int initial) {
  const auto last = static_cast<double>(choices.size() - 1);
  Parameter parameter = number_parameter(std::move(word), std::move(name), std::move(group), "",
                                         {0, last, static_cast<double>(initial)});
  parameter.choices = std::move(choices);
  return parameter;
}

}  // namespace knotwave::plugins
