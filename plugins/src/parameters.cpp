// SPDX-License-Identifier: MIT
#include "knotwave/plugins/parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "knotwave/engine/target_words.h"

namespace knotwave::plugins {
namespace {

/// What slots whose word ends so have in common.
struct Kind {
  std::string_view ending;  ///< of the word
  std::string_view unit;
  double low, high;
};
constexpr Kind kKinds[] = {
    {"amp", "dB", -60, 12},
    {"level", "dB", -60, 12},
    {"drive", "dB", -24, 24},
    {"gain", "", -1, 1},
    {"pitch", "semitones", -48, 48},
    {"cutoff", "semitones", -96, 96},
    {"pan", "", -1, 1},
    {"phase", "cycles", -1, 1},
    {"position", "", -1, 1},
    {"resonance", "", -1, 1},
    {"crossfade", "", -1, 1},
    {"rate", "octaves", -5, 5},
    {"time", "octaves", -5, 5},
    {"", "", -1, 1},  // free numbers and moved ones
};
/// The noise has neither.
constexpr std::string_view kOfNobody[] = {"noise.pitch", "noise.phase", "noise.position"};

const Kind& kind_of(std::string_view word) {
  return *std::find_if(std::begin(kKinds), std::end(kKinds),
                       [word](const Kind& kind) { return word.ends_with(kind.ending); });
}

std::uint32_t id_of(std::string_view symbol) {
  std::uint32_t hash = 2166136261u;
  for (const char letter : symbol) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 16777619u;
  }
  return hash & 0x7FFFFFFFu;
}

std::string capital(std::string word) {
  if (!word.empty() && word[0] >= 'a' && word[0] <= 'z') {
    word[0] = static_cast<char>(word[0] - 'a' + 'A');
  }
  return word;
}

/// "oscillator.1.level": of "Oscillator 1", named "Oscillator 1 level".
void name(Parameter& parameter) {
  parameter.symbol = parameter.word;
  std::replace(parameter.symbol.begin(), parameter.symbol.end(), '.', '_');
  std::string text = parameter.word;
  if (text.starts_with("free.")) text = "macro." + text.substr(5);
  if (text.starts_with("moved.")) text = "moved number." + text.substr(6);
  const std::size_t last = text.rfind('.');
  parameter.group = last == std::string::npos ? "Voice" : text.substr(0, last);
  if (parameter.group == "macro" || parameter.group == "moved number") parameter.group += "s";
  for (std::string* words : {&text, &parameter.group}) {
    std::replace(words->begin(), words->end(), '.', ' ');
    *words = capital(std::move(*words));
  }
  parameter.name = text;
  for (std::string* words : {&parameter.name, &parameter.group}) {
    if (words->starts_with("Lfo")) words->replace(0, 3, "LFO");
  }
}

std::vector<Parameter> table() {
  std::vector<Parameter> all;
  for (int slot = 0; slot < engine::kSlotCount; ++slot) {
    Parameter parameter;
    parameter.word = engine::slot_word(slot);
    if (std::count(std::begin(kOfNobody), std::end(kOfNobody), parameter.word) != 0) continue;
    name(parameter);
    const Kind& kind = kind_of(parameter.word);
    parameter.id = id_of(parameter.symbol);
    parameter.unit = kind.unit;
    parameter.low = kind.low;
    parameter.high = kind.high;
    parameter.slot = slot;
    all.push_back(std::move(parameter));
  }
  return all;
}

template <class Member>
std::size_t find(Member Parameter::*member, const Member& value) {
  const auto all = parameters();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.*member == value; });
  return static_cast<std::size_t>(found - all.begin());
}

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char letter) { return letter == ' ' || letter == '\t'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

std::span<const Parameter> parameters() {
  static const std::vector<Parameter> all = table();
  return all;
}

std::size_t parameter_of_id(std::uint32_t id) { return find(&Parameter::id, id); }
std::size_t parameter_of_word(std::string_view word) {
  return find(&Parameter::word, std::string(word));
}

std::string parameter_text(const Parameter& parameter, double value) {
  const double held = value == value ? std::clamp(value, parameter.low, parameter.high) : 0;
  char digits[32];
  const auto [end, status] =
      std::to_chars(digits, digits + sizeof digits, std::floor(held * 1000 + 0.5) / 1000 + 0.0,
                    std::chars_format::fixed, 3);
  std::string text(digits, end);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  if (text == "-0") text = "0";
  return parameter.unit.empty() ? text : text + " " + std::string(parameter.unit);
}

Result<double> parameter_value(const Parameter& parameter, std::string_view text) {
  std::string_view rest = trimmed(text);
  if (rest.ends_with(parameter.unit)) rest.remove_suffix(parameter.unit.size());
  rest = trimmed(rest);
  if (rest.starts_with('+')) rest.remove_prefix(1);
  double value = 0;
  const auto [end, status] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (status != std::errc{} || end != rest.data() + rest.size() || value != value) {
    return fail(ErrorCode::wrong_type,
                "'" + std::string(text) + "' is no value of " + parameter.name + ": a number" +
                    (parameter.unit.empty() ? "" : " of " + std::string(parameter.unit)) +
                    " must be here");
  }
  return std::clamp(value, parameter.low, parameter.high);
}

}  // namespace knotwave::plugins
