// SPDX-License-Identifier: MIT
// What must not come to toml++ 3.3.0: texts that nest too deep for anything recursive (brackets,
// and dotted keys, of which each dot makes a table), and letters that are not ASCII where TOML has
// none, which its tables of Unicode take for impossible (undefined behaviour).
#pragma once
#include <string>
#include <string_view>

namespace knotwave::base {

/// The first such place of a text; line 0 if there is none. In a text that is no TOML the answer
/// holds up to the first fault.
struct GuardFault {
  int line = 0;
  int column = 0;
  std::string message;
};
GuardFault find_guard_fault(std::string_view text);

std::string too_deep_message();

}  // namespace knotwave::base
