// SPDX-License-Identifier: MIT
// Curve files: what kind of file it is, and the set of curves in it.
#include "knotwave/curves/curve_file.h"

#include <algorithm>

#include "knotwave/base/file.h"
#include "knotwave/base/suggest.h"

namespace knotwave::curves {
namespace {

constexpr int kFormatVersion = 1;
constexpr std::string_view kKindWords[] = {"curve",      "patch",  "bank",       "envelope",
                                           "midi-learn", "plugin", "calibration"};

Error fault(const base::Node& at, std::string_view source, ErrorCode code, std::string message) {
  Error error = fail(code, std::move(message));
  error.source = source;
  error.line = std::max(at.line, 1);
  error.column = std::max(at.column, 1);
  return error;
}

Error missing_first_lines(const base::Node& root, std::string_view source, std::string_view key) {
  for (const base::Node::Member& member : root.members) {
    const std::string hint = base::suggestion(member.key, {&key, 1});
    if (hint.empty()) continue;
    Error error =
        fault(root, source, ErrorCode::unknown_key, "unknown key '" + member.key + "'" + hint);
    error.line = member.line;
    error.column = member.column;
    return error;
  }
  return fault(root, source, ErrorCode::missing_key,
               "'" + std::string(key) +
                   "' is missing; a file begins with format = 1 and kind = \"curve\", \"patch\", "
                   "\"bank\" or \"envelope\"");
}

template <class Item>
const Item* find_named(const std::vector<Item>& items, std::string_view name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const Item& i) { return i.name() == name; });
  return found != items.end() ? &*found : nullptr;
}

}  // namespace

const NurbsCurve* CurveSet::find_curve(std::string_view name) const {
  return find_named(curves, name);
}

const NurbsSurface* CurveSet::find_surface(std::string_view name) const {
  return find_named(surfaces, name);
}

std::vector<std::string_view> CurveSet::names() const {
  std::vector<std::string_view> names;
  names.reserve(curves.size() + surfaces.size());
  for (const NurbsCurve& curve : curves) names.push_back(curve.name());
  for (const NurbsSurface& surface : surfaces) names.push_back(surface.name());
  return names;
}

bool is_valid_name(std::string_view name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), allowed);
}

Result<FileKind> read_file_kind(const base::Node& root, std::string_view source_name) {
  const base::Node* version = root.find("format");
  if (version == nullptr) return missing_first_lines(root, source_name, "format");
  if (version->kind != base::Node::Kind::integer) {
    return fault(*version, source_name, ErrorCode::wrong_type,
                 "format must be a whole number: format = 1");
  }
  if (version->integer != kFormatVersion) {
    return fault(*version, source_name, ErrorCode::unsupported_version,
                 "format is " + std::to_string(version->integer) + "; this program reads format " +
                     std::to_string(kFormatVersion));
  }
  const base::Node* kind = root.find("kind");
  if (kind == nullptr) return missing_first_lines(root, source_name, "kind");
  if (kind->kind != base::Node::Kind::string) {
    return fault(*kind, source_name, ErrorCode::wrong_type,
                 "kind must be a string: kind = \"curve\"");
  }
  const auto* word = std::find(std::begin(kKindWords), std::end(kKindWords), kind->text);
  if (word == std::end(kKindWords)) {
    return fault(*kind, source_name, ErrorCode::unknown_name,
                 "kind is '" + kind->text +
                     "'; it must be one of curve, patch, bank, envelope, midi-learn, plugin, "
                     "calibration" +
                     base::suggestion(kind->text, kKindWords));
  }
  return static_cast<FileKind>(word - std::begin(kKindWords));
}

Result<CurveSet> parse_curves(std::string_view text, std::string_view source_name) {
  const auto root = base::parse_document(text, source_name);
  if (!root) return root.error();
  const auto kind = read_file_kind(*root, source_name);
  if (!kind) return kind.error();
  if (*kind != FileKind::curve) {
    return fault(*root->find("kind"), source_name, ErrorCode::unsupported,
                 "this file's kind is '" + root->find("kind")->text +
                     "'; a curve file (kind = \"curve\") is needed here");
  }
  auto set = read_curve_tables(*root, source_name);
  if (!set) return set;
  base::TableReader reader(*root, source_name, "curve file");
  for (const char* key : {"format", "kind", "curves", "surfaces"}) reader.node(key);
  if (const auto unknown = reader.finish(); !unknown) return unknown.error();
  if (set->curves.empty() && set->surfaces.empty()) {
    return fault(*root, source_name, ErrorCode::missing_key,
                 "the file has no curve; begin one with [curves.NAME]");
  }
  return set;
}

Result<CurveSet> read_curves(const std::string& path) {
  const auto text = base::read_file(path, base::kMaxDocumentBytes);
  if (!text) return text.error();
  return parse_curves(*text, path);
}

}  // namespace knotwave::curves
