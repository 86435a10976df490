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
/// more. Then the longest known one of three letters or more that `word` begins with. Else empty.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> known);

/// `; did you mean 'x'?` or empty: ready to append to an error message. Up to three words that
/// begin with `word` are named, `'x', 'y' or 'z'`, where none is nearest.
std::string suggestion(std::string_view word, std::span<const std::string_view> known);

/// What others call a word of ours.
struct Synonym {
  std::string_view theirs;  ///< in small letters, without '_', '-' and blanks, which do not count
  std::string_view ours;
};
/// The same; but where `theirs` is the word and `ours` is known, that is meant.
std::string suggestion(std::string_view word, std::span<const std::string_view> known,
                       std::span<const Synonym> synonyms);

}  // namespace knotwave::base
