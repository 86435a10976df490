// SPDX-License-Identifier: MIT
// Text as JSON wants it.
#pragma once
#include <string>
#include <string_view>

namespace knotwave::command_line {

/// Any bytes as a JSON string with its quotes (RFC 8259, section 7). Controls are escaped, so that
/// they come back and no terminal obeys them; what is no UTF-8 becomes U+FFFD.
std::string json_string(std::string_view text);

}  // namespace knotwave::command_line
