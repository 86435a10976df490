// SPDX-License-Identifier: MIT
// TOML text to a tree of nodes. The only file that sees toml++.
#include "knotwave/base/document.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <tuple>

#include "document_guard.h"

#define TOML_EXCEPTIONS 0
#define TOML_HEADER_ONLY 1
#define TOML_FLOAT_CHARCONV 1
#define TOML_INT_CHARCONV 1
#define TOML_MAX_NESTED_VALUES 32
#define TOML_ENABLE_FORMATTERS 0
// toml++ 3.3.0 claims that some faults cannot be, such as "[.a]": it aborts on them, and with
// NDEBUG even builds on the claim (undefined behaviour). Without its claims it reports them.
#undef NDEBUG
#define TOML_ASSERT(claim) static_assert(true)
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#endif
#include <toml++/toml.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace knotwave::base {
namespace {

/// Where the text stands: a value's own place, or its key's when toml++ knows none.
struct Place {
  int line = 1;
  int column = 1;
};

Place place_of(const toml::source_position& position, Place otherwise) {
  if (position.line == 0) return otherwise;
  return {static_cast<int>(position.line), static_cast<int>(position.column)};
}

Error error_at(ErrorCode code, std::string message, Place place) {
  Error error = fail(code, std::move(message));
  error.line = place.line;
  error.column = place.column;
  return error;
}

Result<Node> convert(const toml::node& from, Place otherwise, int depth);

Result<Node> convert_table(const toml::table& from, Node node, int depth) {
  for (const auto& [key, value] : from) {
    const Place place = place_of(key.source().begin, {node.line, node.column});
    Result<Node> child = convert(value, place, depth + 1);
    if (!child) return child;
    node.members.push_back({std::string(key.str()), place.line, place.column, std::move(*child)});
  }
  // toml++ sorts keys by name; the author's order is that of their places.
  std::stable_sort(node.members.begin(), node.members.end(), [](const auto& a, const auto& b) {
    return std::tie(a.line, a.column) < std::tie(b.line, b.column);
  });
  return node;
}

Result<Node> convert_array(const toml::array& from, Node node, int depth) {
  node.items.reserve(from.size());
  for (const toml::node& item : from) {
    Result<Node> child = convert(item, {node.line, node.column}, depth + 1);
    if (!child) return child;
    node.items.push_back(std::move(*child));
  }
  return node;
}

Result<Node> convert_real(double value, Node node, Place place) {
  if (!std::isfinite(value)) {
    return error_at(ErrorCode::syntax, "a number must be finite; nan and inf are not allowed",
                    place);
  }
  node.kind = Node::Kind::real;
  node.number = value;
  return node;
}

Result<Node> convert(const toml::node& from, Place otherwise, int depth) {
  const Place place = place_of(from.source().begin, otherwise);
  if (depth > kMaxDocumentDepth) return error_at(ErrorCode::syntax, too_deep_message(), place);
  Node node;
  node.line = place.line;
  node.column = place.column;
  switch (from.type()) {
    case toml::node_type::table:
      return convert_table(*from.as_table(), std::move(node), depth);
    case toml::node_type::array:
      node.kind = Node::Kind::array;
      return convert_array(*from.as_array(), std::move(node), depth);
    case toml::node_type::string:
      node.kind = Node::Kind::string;
      node.text = from.as_string()->get();
      return node;
    case toml::node_type::integer:
      node.kind = Node::Kind::integer;
      node.integer = from.as_integer()->get();
      node.number = static_cast<double>(node.integer);
      return node;
    case toml::node_type::floating_point:
      return convert_real(from.as_floating_point()->get(), std::move(node), place);
    case toml::node_type::boolean:
      node.kind = Node::Kind::boolean;
      node.boolean = from.as_boolean()->get();
      return node;
    default:
      return error_at(ErrorCode::wrong_type, "dates and times have no meaning here", place);
  }
}

/// toml++ starts with "Error while parsing ...: " (our line says error already) and may quote the
/// whole of a long token.
std::string plain_words(std::string_view description) {
  constexpr std::string_view kPrefix = "Error while parsing ";
  constexpr std::size_t kLongest = 200;
  if (description.starts_with(kPrefix)) description.remove_prefix(kPrefix.size());
  if (description.starts_with("Encountered")) return "e" + std::string(description.substr(1));
  if (description.size() > kLongest) return std::string(description.substr(0, kLongest)) + "...";
  return std::string(description);
}

Result<Node> parse_checked(std::string_view text) {
  if (text.size() > kMaxDocumentBytes) {
    return fail(ErrorCode::file_too_large, "the file has " + std::to_string(text.size()) +
                                               " bytes; at most " +
                                               std::to_string(kMaxDocumentBytes) + " are read");
  }
  if (GuardFault fault = find_guard_fault(text); fault.line > 0) {
    return error_at(ErrorCode::syntax, std::move(fault.message), {fault.line, fault.column});
  }
  const toml::parse_result parsed = toml::parse(text);
  if (!parsed) {
    const toml::parse_error& error = parsed.error();
    return error_at(ErrorCode::syntax, plain_words(error.description()),
                    place_of(error.source().begin, {}));
  }
  return convert(parsed.table(), {}, 0);
}

}  // namespace

const Node* Node::find(std::string_view key) const {
  for (const Member& member : members) {
    if (member.key == key) return &member.value;
  }
  return nullptr;
}

Result<Node> parse_document(std::string_view text, std::string_view source_name) {
  Result<Node> parsed = parse_checked(text);
  if (parsed) return parsed;
  Error error = std::move(parsed).error();
  error.source = source_name;
  return error;
}

}  // namespace knotwave::base
