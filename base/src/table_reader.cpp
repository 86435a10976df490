// SPDX-License-Identifier: MIT
// Typed reading of a table, and numbers as text.
#include <algorithm>
#include <array>
#include <charconv>

#include "knotwave/base/document.h"
#include "knotwave/base/suggest.h"

namespace knotwave::base {
namespace {

const char* kind_name(Node::Kind kind) {
  switch (kind) {
    case Node::Kind::table:
      return "a table";
    case Node::Kind::array:
      return "an array";
    case Node::Kind::string:
      return "a string";
    case Node::Kind::integer:
      return "a whole number";
    case Node::Kind::real:
      return "a decimal number";
    case Node::Kind::boolean:
      return "true or false";
  }
  return "a value";
}

std::string wrong_type_message(std::string_view what, std::string_view expected,
                               const Node& found) {
  return std::string(what) + " must be " + std::string(expected) + ", not " + kind_name(found.kind);
}

std::string range_message(std::string_view key, double value, double low, double high) {
  return std::string(key) + " is " + number_text(value) + "; it must be in " + number_text(low) +
         " to " + number_text(high);
}

}  // namespace

std::string number_text(double value) {
  std::array<char, 32> buffer;
  const auto [end, code] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  static_cast<void>(code);  // the longest double has 24 characters
  return {buffer.data(), end};
}

TableReader::TableReader(const Node& table, std::string_view source_name, std::string what)
    : table_(table), source_(source_name), what_(std::move(what)) {}

void TableReader::fail_at(const Node& at, ErrorCode code, std::string message) {
  if (!ok_) return;
  ok_ = false;
  error_ = fail(code, what_ + ": " + std::move(message));
  error_.source = source_;
  error_.line = at.line;
  error_.column = at.column;
}

const Node* TableReader::node(std::string_view key) {
  known_.push_back(key);
  return table_.find(key);
}

const Node* TableReader::table(std::string_view key) {
  const Node* found = node(key);
  if (found == nullptr || found->kind == Node::Kind::table) return found;
  fail_at(*found, ErrorCode::wrong_type, wrong_type_message(key, "a table", *found));
  return nullptr;
}

const Node* TableReader::array(std::string_view key) {
  const Node* found = node(key);
  if (found == nullptr || found->kind == Node::Kind::array) return found;
  fail_at(*found, ErrorCode::wrong_type, wrong_type_message(key, "an array", *found));
  return nullptr;
}

const Node* TableReader::required(std::string_view key) {
  const Node* found = node(key);
  if (found != nullptr) return found;
  if (ok_) missing_ = key;
  fail_at(table_, ErrorCode::missing_key, "'" + std::string(key) + "' is missing");
  return nullptr;
}

double TableReader::number_from(const Node& found, std::string_view key, double fallback,
                                double low, double high) {
  if (!found.is_number()) {
    fail_at(found, ErrorCode::wrong_type, wrong_type_message(key, "a number", found));
    return fallback;
  }
  if (!(found.number >= low && found.number <= high)) {
    fail_at(found, ErrorCode::value_out_of_range, range_message(key, found.number, low, high));
    return fallback;
  }
  return found.number;
}

double TableReader::number(std::string_view key, double fallback, double low, double high) {
  const Node* found = node(key);
  return found == nullptr ? fallback : number_from(*found, key, fallback, low, high);
}

double TableReader::number(std::string_view key, double low, double high) {
  const Node* found = required(key);
  return found == nullptr ? low : number_from(*found, key, low, low, high);
}

int TableReader::integer(std::string_view key, int fallback, int low, int high) {
  const Node* found = node(key);
  if (found == nullptr) return fallback;
  if (found->kind != Node::Kind::integer) {
    fail_at(*found, ErrorCode::wrong_type, wrong_type_message(key, "a whole number", *found));
    return fallback;
  }
  if (found->integer < low || found->integer > high) {
    fail_at(*found, ErrorCode::value_out_of_range,
            std::string(key) + " is " + std::to_string(found->integer) + "; it must be in " +
                std::to_string(low) + " to " + std::to_string(high));
    return fallback;
  }
  return static_cast<int>(found->integer);
}

bool TableReader::boolean(std::string_view key, bool fallback) {
  const Node* found = node(key);
  if (found == nullptr) return fallback;
  if (found->kind == Node::Kind::boolean) return found->boolean;
  fail_at(*found, ErrorCode::wrong_type, wrong_type_message(key, "true or false", *found));
  return fallback;
}

std::string TableReader::string_from(const Node& found, std::string_view key,
                                     std::string_view fallback) {
  if (found.kind == Node::Kind::string) return found.text;
  fail_at(found, ErrorCode::wrong_type, wrong_type_message(key, "a string", found));
  return std::string(fallback);
}

std::string TableReader::string(std::string_view key, std::string_view fallback) {
  const Node* found = node(key);
  return found == nullptr ? std::string(fallback) : string_from(*found, key, fallback);
}

std::string TableReader::string(std::string_view key) {
  const Node* found = required(key);
  return found == nullptr ? std::string{} : string_from(*found, key, "");
}

int TableReader::choice(std::string_view key, int fallback,
                        std::initializer_list<std::string_view> choices) {
  const Node* found = node(key);
  if (found == nullptr) return fallback;
  const std::string word = string_from(*found, key, "");
  if (found->kind != Node::Kind::string) return fallback;
  const auto* const match = std::find(choices.begin(), choices.end(), word);
  if (match != choices.end()) return static_cast<int>(match - choices.begin());
  std::string list;
  for (const std::string_view choice : choices) {
    list += (list.empty() ? "" : ", ") + std::string(choice);
  }
  fail_at(*found, ErrorCode::unknown_name,
          std::string(key) + " is '" + word + "'; it must be one of " + list +
              suggestion(word, {choices.begin(), choices.size()}));
  return fallback;
}

std::vector<double> TableReader::numbers(std::string_view key) {
  std::vector<double> values;
  const Node* found = array(key);
  if (found == nullptr) return values;
  values.reserve(found->items.size());
  for (const Node& item : found->items) {
    if (!item.is_number()) {
      const std::string place = std::string(key) + "[" + std::to_string(values.size()) + "]";
      fail_at(item, ErrorCode::wrong_type, wrong_type_message(place, "a number", item));
      return {};
    }
    values.push_back(item.number);
  }
  return values;
}

Error TableReader::unknown_key(const Node::Member& member, std::string_view hint) const {
  Error error = fail(ErrorCode::unknown_key,
                     what_ + ": unknown key '" + member.key + "'" + std::string(hint));
  error.source = source_;
  error.line = member.line;
  error.column = member.column;
  return error;
}

Result<void> TableReader::finish() {
  if (!ok_ && missing_.empty()) return error_;
  for (const Node::Member& member : table_.members) {
    if (std::find(known_.begin(), known_.end(), member.key) != known_.end()) continue;
    if (ok_) return unknown_key(member, suggestion(member.key, known_));
    const std::string hint = suggestion(member.key, {&missing_, 1});
    if (!hint.empty()) return unknown_key(member, hint);
  }
  if (!ok_) return error_;
  return {};
}

}  // namespace knotwave::base
