// SPDX-License-Identifier: MIT
// Edit distance with swaps of neighbours (the "optimal string alignment" form).
#include "knotwave/base/suggest.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

namespace knotwave::base {
namespace {

/// Longer words are not compared: the cost is the product of the lengths.
constexpr std::size_t kMaxWord = 64;
/// A shorter beginning says too little, of either word.
constexpr std::size_t kMinBeginning = 3;
/// More words that begin so are a list, not a suggestion.
constexpr std::size_t kMaxMeant = 3;

/// ASCII only, in any locale.
std::string lower_case(std::string_view word) {
  std::string lower(word);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

/// The known words that begin so.
std::vector<std::string_view> completed(std::string_view word,
                                        std::span<const std::string_view> known) {
  std::vector<std::string_view> found;
  if (word.size() < kMinBeginning) return found;
  std::copy_if(known.begin(), known.end(), std::back_inserter(found),
               [word](std::string_view candidate) { return candidate.starts_with(word); });
  return found;
}

/// The longest known word that begins `lower`.
std::string_view longest_beginning(std::string_view lower,
                                   std::span<const std::string_view> known) {
  std::string_view longest;
  for (const std::string_view candidate : known) {
    if (candidate.size() < kMinBeginning || candidate.size() <= longest.size()) continue;
    if (lower.starts_with(lower_case(candidate))) longest = candidate;
  }
  return longest;
}

/// A word as Synonym::theirs has it.
std::string bare(std::string_view word) {
  std::string text = lower_case(word);
  std::erase_if(text, [](char c) { return c == '_' || c == '-' || c == ' '; });
  return text;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> before(width), above(width), row(width);
  for (std::size_t j = 0; j < width; ++j) above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j < width; ++j) {
      const std::size_t replace = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, replace});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(above);
    above.swap(row);
  }
  return above[b.size()];
}

}  // namespace

std::string_view nearest_word(std::string_view word, std::span<const std::string_view> known) {
  if (word.size() > kMaxWord) return {};
  std::string_view best;
  std::size_t best_distance = kMaxWord;
  const std::string lower = lower_case(word);
  for (const std::string_view candidate : known) {
    if (candidate.size() > kMaxWord) continue;
    const std::size_t distance = edit_distance(lower, lower_case(candidate));
    const std::size_t longer = std::max(word.size(), candidate.size());
    if (2 * distance > longer || distance > std::max<std::size_t>(1, longer / 3)) continue;
    if (distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  if (!best.empty()) return best;
  const auto longer_words = completed(word, known);
  if (longer_words.size() == 1) return longer_words.front();
  return longer_words.empty() ? longest_beginning(lower, known) : std::string_view{};
}

std::string suggestion(std::string_view word, std::span<const std::string_view> known) {
  std::vector<std::string_view> meant = {nearest_word(word, known)};
  if (meant.front().empty()) meant = completed(word, known);
  if (meant.empty() || meant.size() > kMaxMeant) return {};
  std::string text = "; did you mean ";
  for (std::size_t i = 0; i < meant.size(); ++i) {
    text += i == 0 ? "'" : i + 1 < meant.size() ? ", '" : " or '";
    text += std::string(meant[i]) + "'";
  }
  return text + "?";
}

std::string suggestion(std::string_view word, std::span<const std::string_view> known,
                       std::span<const Synonym> synonyms) {
  if (word.size() > kMaxWord) return {};
  const std::string theirs = bare(word);
  for (const Synonym& synonym : synonyms) {
    if (synonym.theirs != theirs) continue;
    if (std::find(known.begin(), known.end(), synonym.ours) == known.end()) continue;
    return "; did you mean '" + std::string(synonym.ours) + "'?";
  }
  return suggestion(word, known);
}

}  // namespace knotwave::base
