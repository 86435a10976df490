// SPDX-License-Identifier: MIT
// What our programs print as their result.
#pragma once
#include <string_view>

namespace knotwave::command_line {

/// Gives closed standard streams a place that cannot be written to. Before anything is opened: the
/// next file would take such a place, and what is printed would go into it.
void guard_standard_streams();
/// Whether guard_standard_streams() found no standard input.
bool is_standard_input_closed();

/// `text` on standard output. Where that fails (a full disk, a reader that has gone) the reason is
/// told on standard error. Returns the exit code.
int print(std::string_view program, std::string_view text);

}  // namespace knotwave::command_line
