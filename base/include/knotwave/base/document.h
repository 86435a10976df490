// SPDX-License-Identifier: MIT
// A TOML document as a plain tree with the place of every value, and a reader of tables that turns
// wrong types and unknown keys into errors with line and column. toml++ is seen by document.cpp
// only. [control] throughout.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "knotwave/base/result.h"

namespace knotwave::base {

inline constexpr std::size_t kMaxDocumentBytes = 1 << 20;
inline constexpr int kMaxDocumentDepth = 32;

/// A value of a document.
struct Node {
  enum class Kind { table, array, string, integer, real, boolean };
  Kind kind = Kind::table;
  int line = 0;
  int column = 0;
  std::string text;          ///< string
  std::int64_t integer = 0;  ///< integer
  double number = 0;         ///< integer or real
  bool boolean = false;
  std::vector<Node> items;  ///< array
  struct Member;
  std::vector<Member> members;  ///< table, in the order of the file

  /// The member called `key` of a table, or null.
  const Node* find(std::string_view key) const;
  bool is_number() const { return kind == Kind::integer || kind == Kind::real; }
};
struct Node::Member {
  std::string key;
  int line = 0;
  int column = 0;
  Node value;
};

/// Text to a tree. Errors (with source, line and column): file_too_large (over 1 MiB), syntax (also
/// bad UTF-8, duplicate keys, depth over 32, NaN and infinity), wrong_type (dates). A byte order
/// mark is accepted.
Result<Node> parse_document(std::string_view text, std::string_view source_name);

/// Reads the members of one table. Every get() marks its key as known; finish() reports the first
/// key nobody asked for, with the nearest known one. The first error is kept, later calls return
/// their defaults, so a caller may read everything and then ask once.
class TableReader {
 public:
  /// `what` names the table in messages, such as "curve 'bell'".
  TableReader(const Node& table, std::string_view source_name, std::string what);

  double number(std::string_view key, double fallback, double low, double high);
  double number(std::string_view key, double low, double high);  ///< required
  int integer(std::string_view key, int fallback, int low, int high);
  bool boolean(std::string_view key, bool fallback);
  std::string string(std::string_view key, std::string_view fallback);
  std::string string(std::string_view key);  ///< required
  /// Index of the word in `choices`; a wrong one is unknown_name with a suggestion.
  int choice(std::string_view key, int fallback, std::initializer_list<std::string_view> choices);
  std::vector<double> numbers(std::string_view key);  ///< empty when absent
  /// The raw member, or null; marks the key as known.
  const Node* node(std::string_view key);
  const Node* required(std::string_view key);  ///< missing_key when absent
  const Node* table(std::string_view key);     ///< null when absent; wrong_type if no table
  const Node* array(std::string_view key);     ///< null when absent; wrong_type if no array

  bool ok() const { return ok_; }
  /// Keeps an error at the place of `at` unless there is one already.
  void fail_at(const Node& at, ErrorCode code, std::string message);
  /// The first error, or unknown_key for the first key not asked for. A missing key that stands
  /// there misspelt is told as unknown_key too.
  Result<void> finish();

 private:
  Error unknown_key(const Node::Member& member, std::string_view hint) const;
  double number_from(const Node& found, std::string_view key, double fallback, double low,
                     double high);
  std::string string_from(const Node& found, std::string_view key, std::string_view fallback);

  const Node& table_;
  std::string source_;
  std::string what_;
  std::vector<std::string_view> known_;
  std::string_view missing_;
  bool ok_ = true;
  Error error_;
};

/// Shortest text that reads back as the same double (to_chars). Integers get no ".0".
std::string number_text(double value);

}  // namespace knotwave::base
