// SPDX-License-Identifier: MIT
// Words of the journal's text that its writer and its reader share.
#pragma once
#include <string_view>

namespace knotwave::engine {

inline constexpr std::string_view kMagic = "knotwave-journal";
inline constexpr std::string_view kEverySlotWord = "all";
inline constexpr std::string_view kEveryWord = "every", kNoteWord = "note";
inline constexpr std::string_view kPressureWord = "pressure", kTimbreWord = "timbre";

}  // namespace knotwave::engine
