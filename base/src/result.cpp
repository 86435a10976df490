// SPDX-License-Identifier: MIT
// Names of error codes, the text of an error, and the end of a failed assertion.
#include "knotwave/base/result.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace knotwave::base {

void assertion_failed(const char* claim, const char* file, int line) noexcept {
  std::fprintf(stderr, "%s:%d: assertion failed: %s\n", file, line, claim);
  std::abort();
}

const char* to_string(ErrorCode code) noexcept {
  switch (code) {
#define KNOTWAVE_NAME(name) \
  case ErrorCode::name:     \
    return #name
    KNOTWAVE_NAME(degree_out_of_range);
    KNOTWAVE_NAME(too_few_points);
    KNOTWAVE_NAME(too_many_points);
    KNOTWAVE_NAME(dimension_mismatch);
    KNOTWAVE_NAME(knot_count_mismatch);
    KNOTWAVE_NAME(knots_decrease);
    KNOTWAVE_NAME(knot_multiplicity);
    KNOTWAVE_NAME(empty_domain);
    KNOTWAVE_NAME(weight_count_mismatch);
    KNOTWAVE_NAME(weight_not_positive);
    KNOTWAVE_NAME(weight_out_of_range);
    KNOTWAVE_NAME(coordinate_out_of_range);
    KNOTWAVE_NAME(not_finite);
    KNOTWAVE_NAME(parameter_out_of_range);
    KNOTWAVE_NAME(not_a_function);
    KNOTWAVE_NAME(not_scalar);
    KNOTWAVE_NAME(not_closed);
    KNOTWAVE_NAME(error_bound_missed);
    KNOTWAVE_NAME(control_conflict);
    KNOTWAVE_NAME(file_not_found);
    KNOTWAVE_NAME(file_too_large);
    KNOTWAVE_NAME(io_failed);
    KNOTWAVE_NAME(disk_full);
    KNOTWAVE_NAME(syntax);
    KNOTWAVE_NAME(unknown_key);
    KNOTWAVE_NAME(missing_key);
    KNOTWAVE_NAME(wrong_type);
    KNOTWAVE_NAME(value_out_of_range);
    KNOTWAVE_NAME(unknown_name);
    KNOTWAVE_NAME(duplicate_name);
    KNOTWAVE_NAME(cyclic_reference);
    KNOTWAVE_NAME(unsupported_version);
    KNOTWAVE_NAME(unsupported_format);
    KNOTWAVE_NAME(malformed);
    KNOTWAVE_NAME(usage);
    KNOTWAVE_NAME(interrupted);
    KNOTWAVE_NAME(unsupported);
#undef KNOTWAVE_NAME
  }
  return "unknown";
}

namespace {
/// File names and keys come from strangers: a terminal must not obey what they hold.
std::string printable(const std::string& text) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte != 0x7f) {
      out += c;
    } else {
      out += {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
    }
  }
  return out;
}

/// `text` with its middle left out where it is longer than `most` bytes; no UTF-8 letter is cut.
std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  const auto goes_on = [&](std::size_t at) { return (text[at] & 0xC0) == 0x80; };
  std::size_t head = most * 2 / 3, tail = text.size() - (most - head - 3);
  while (head > 0 && goes_on(head)) --head;
  while (tail < text.size() && goes_on(tail)) ++tail;
  return std::string(text.substr(0, head)) + "..." + std::string(text.substr(tail));
}

/// Names come from files and may fill them: long words are cut, and so is the whole.
std::string readable(const std::string& message) {
  constexpr std::size_t kLongestWord = 80, kLongestMessage = 2000;
  const std::string text = printable(shortened(message, kLongestMessage * 2));
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" /", at), text.size());
    out += shortened(std::string_view(text).substr(at, end - at), kLongestWord);
    if (end < text.size()) out += text[end];
    at = end + 1;
  }
  return shortened(out, kLongestMessage);
}
}  // namespace

std::string Error::to_string() const {
  std::string text;
  if (!source.empty()) text += printable(source) + ":";
  if (line > 0) {
    text += std::to_string(line) + ":";
    if (column > 0) text += std::to_string(column) + ":";
  }
  if (offset >= 0) {
    if (!text.empty()) text += " ";
    text += "byte " + std::to_string(offset) + ":";
  }
  if (!text.empty()) text += " ";
  return text + "error: " + readable(message);
}

}  // namespace knotwave::base
