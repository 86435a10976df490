// SPDX-License-Identifier: MIT
// Text as JSON wants it.
#pragma once
#include <string>
#include <string_view>

namespace knotwave::command_line {

/// UTF-8 text as a JSON string with its quotes (RFC 8259, section 7).
std::string json_string(std::string_view text);

}  // namespace knotwave::command_line
