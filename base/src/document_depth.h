// SPDX-License-Identifier: MIT
// Refuses texts that nest too deep before anything recursive sees them: brackets, and dotted keys,
// of which each dot makes a table.
#pragma once
#include <string>
#include <string_view>

namespace knotwave::base {

/// Where a text first nests over kMaxDocumentDepth; line 0 if nowhere. Strings and comments are
/// skipped. In a text that is no TOML the answer holds up to the first fault.
struct DeepPlace {
  int line = 0;
  int column = 0;
};
DeepPlace find_too_deep(std::string_view text);

std::string too_deep_message();

}  // namespace knotwave::base
