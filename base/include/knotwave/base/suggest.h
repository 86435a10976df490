// SPDX-License-Identifier: MIT
// "Did you mean": the nearest known word to a wrong one. [control]
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace knotwave::base {

/// The known word with the smallest edit distance (insert, delete, replace, swap neighbours; ASCII
/// case does not count) unless that is more than one and more than a third of the longer word, or
/// more than half of it. Then the only known word that begins with `word`, of three letters or
/// more. Else empty.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> known);

/// `; did you mean 'x'?` or empty: ready to append to an error message. Up to three words that
/// begin with `word` are named, `'x', 'y' or 'z'`, where none is nearest.
std::string suggestion(std::string_view word, std::span<const std::string_view> known);

}  // namespace knotwave::base
