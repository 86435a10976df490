// SPDX-License-Identifier: MIT
// The fixed table of files being written, so that a signal handler can remove them.
#pragma once
#include <string_view>

namespace knotwave::base {

inline constexpr int kMaxUnfinishedFiles = 64;

/// Slot that now names `part_path`; -1 when the table is full or the path longer than it holds.
int note_unfinished_file(std::string_view part_path) noexcept;
void forget_unfinished_file(int slot) noexcept;
bool is_unfinished_here(std::string_view part_path) noexcept;

}  // namespace knotwave::base
