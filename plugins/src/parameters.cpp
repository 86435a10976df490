// SPDX-License-Identifier: MIT
#include "knotwave/plugins/parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace knotwave::plugins {
namespace {

std::uint32_t id_of(std::string_view symbol) {
  std::uint32_t hash = 2166136261u;
  for (const char letter : symbol) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 16777619u;
  }
  return hash & 0x7FFFFFFFu;
}

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char letter) { return letter == ' ' || letter == '\t'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string expected(const Parameter& parameter) {
  if (parameter.choices.empty()) {
    return parameter.unit.empty() ? "a number" : "a number of " + std::string(parameter.unit);
  }
  std::string words;
  for (const std::string& choice : parameter.choices) {
    words += (words.empty() ? "" : ", ") + choice;
  }
  return "one of " + words;
}

/// Of choices' words; choices.size(): none.
std::size_t choice_of(const Parameter& parameter, std::string_view word) {
  const auto found = std::find(parameter.choices.begin(), parameter.choices.end(), word);
  return static_cast<std::size_t>(found - parameter.choices.begin());
}

}  // namespace

ParameterTable::ParameterTable(std::vector<Parameter> all) : all_(std::move(all)) {
  for (Parameter& parameter : all_) {
    parameter.symbol = parameter.word;
    std::replace(parameter.symbol.begin(), parameter.symbol.end(), '.', '_');
    parameter.id = id_of(parameter.symbol);
    by_id_.emplace_back(parameter.id, by_id_.size());
  }
  std::sort(by_id_.begin(), by_id_.end());
}

std::size_t ParameterTable::of_id(std::uint32_t id) const KNOTWAVE_RT {
  const auto found = std::lower_bound(by_id_.begin(), by_id_.end(), std::pair{id, std::size_t{0}});
  return found != by_id_.end() && found->first == id ? found->second : size();
}

std::size_t ParameterTable::of_word(std::string_view word) const {
  const auto found =
      std::find_if(all_.begin(), all_.end(), [word](const Parameter& p) { return p.word == word; });
  return static_cast<std::size_t>(found - all_.begin());
}

double held(const Parameter& parameter, double value) KNOTWAVE_RT {
  if (value != value) return parameter.initial;
  const double within = std::clamp(value, parameter.low, parameter.high);
  return parameter.choices.empty() ? within : std::floor(within + 0.5);
}

std::string parameter_text(const Parameter& parameter, double value) {
  const double shown = held(parameter, value);
  if (!parameter.choices.empty()) return parameter.choices[static_cast<std::size_t>(shown)];
  char digits[32];
  const auto [end, status] =
      std::to_chars(digits, digits + sizeof digits, std::floor(shown * 1000 + 0.5) / 1000 + 0.0,
                    std::chars_format::fixed, 3);
  std::string text(digits, end);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  if (text == "-0") text = "0";
  return parameter.unit.empty() ? text : text + " " + std::string(parameter.unit);
}

Result<double> parameter_value(const Parameter& parameter, std::string_view text) {
  std::string_view rest = trimmed(text);
  if (const std::size_t choice = choice_of(parameter, rest); choice < parameter.choices.size()) {
    return static_cast<double>(choice);
  }
  if (rest.ends_with(parameter.unit)) rest.remove_suffix(parameter.unit.size());
  rest = trimmed(rest);
  if (rest.starts_with('+')) rest.remove_prefix(1);
  double value = 0;
  const auto [end, status] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (status != std::errc{} || end != rest.data() + rest.size() || value != value) {
    return fail(ErrorCode::wrong_type, "'" + std::string(text) + "' is no value of " +
                                           parameter.name + ": " + expected(parameter) +
                                           " must be here");
  }
  return held(parameter, value);
}

}  // namespace knotwave::plugins
