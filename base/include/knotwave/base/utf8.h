// SPDX-License-Identifier: MIT
// Text of strangers, one code point after another. [any]
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace knotwave::base {

inline constexpr std::string_view kReplacementCharacter = "\xEF\xBF\xBD";  ///< U+FFFD

struct CodePoint {
  std::uint32_t code = 0;
  std::size_t size = 0;  ///< bytes in UTF-8; 0 = these bytes are no UTF-8
};

/// The first code point of a text that is not empty. Overlong forms, surrogates and values past
/// U+10FFFF are no UTF-8 (RFC 3629).
CodePoint first_code_point(std::string_view text) noexcept;

/// Control characters, and those that turn the direction of the text around them: a terminal must
/// not be given them as they are.
bool is_control(std::uint32_t code) noexcept;

}  // namespace knotwave::base
