// SPDX-License-Identifier: MIT
// Text and numbers as JSON wants them.
#pragma once
#include <string>
#include <string_view>

namespace knotwave::command_line {

/// Any bytes as a JSON string with its quotes (RFC 8259, section 7). Controls are escaped, so that
/// they come back and no terminal obeys them; what is no UTF-8 becomes U+FFFD.
std::string json_string(std::string_view text);

/// A double with 17 significant digits, which read back as the same; JSON has no infinity and no
/// not-a-number: those are null.
std::string json_number(double value);

}  // namespace knotwave::command_line
