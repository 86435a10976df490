// SPDX-License-Identifier: MIT
#include "command_line/json.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

#include "knotwave/base/utf8.h"

namespace knotwave::command_line {
namespace {

/// The letter behind the backslash, for those that have one.
std::optional<char> short_escape(std::uint32_t code) {
  switch (code) {
    case '\b':
      return 'b';
    case '\f':
      return 'f';
    case '\n':
      return 'n';
    case '\r':
      return 'r';
    case '\t':
      return 't';
    case '"':
    case '\\':
      return static_cast<char>(code);
    default:
      return std::nullopt;
  }
}

/// Of controls, all of which are below U+10000.
std::string long_escape(std::uint32_t code) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "\\u";
  for (int shift = 12; shift >= 0; shift -= 4) text += kDigits[code >> shift & 15];
  return text;
}

}  // namespace

std::string json_string(std::string_view text) {
  std::string out = "\"";
  while (!text.empty()) {
    const auto [code, size] = base::first_code_point(text);
    if (size == 0) {
      out += base::kReplacementCharacter;
    } else if (const auto letter = short_escape(code)) {
      out += {'\\', *letter};
    } else {
      out += base::is_control(code) ? long_escape(code) : std::string(text.substr(0, size));
    }
    text.remove_prefix(size == 0 ? 1 : size);
  }
  return out + "\"";
}

std::string json_number(double value) {
  if (!std::isfinite(value)) return "null";
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 17).ptr};
}

}  // namespace knotwave::command_line
