// SPDX-License-Identifier: MIT
// What all sections of a patch share: its own keys, the names of curves in their roles.
#include "patch_tables.h"

#include <algorithm>

#include "knotwave/base/suggest.h"
#include "knotwave/curves/algorithms.h"
#include "knotwave/dsp/builtin_waves.h"

#include "text_line.h"

namespace knotwave::engine {
namespace {

// What others call the built-in waves.
constexpr base::Synonym kWaveSynonyms[] = {
    {"sqr", "square"}, {"rect", "square"}, {"rectangle", "square"}, {"pulse", "square"},
    {"ramp", "saw"},   {"cosine", "sine"}, {"tri", "triangle"},
};

// Every key of `table` and of the tables in it. Arrays of numbers are one place.
void note_places(const base::Node& table, const std::string& path, Places& places) {
  for (const base::Node::Member& member : table.members) {
    const std::string name = path.empty() ? member.key : path + "." + member.key;
    places[name] = {std::max(member.value.line, 1), std::max(member.value.column, 1)};
    if (member.value.kind == base::Node::Kind::table) note_places(member.value, name, places);
    for (std::size_t i = 0; i < member.value.items.size(); ++i) {
      const base::Node& item = member.value.items[i];
      if (item.kind != base::Node::Kind::table) continue;
      const std::string number = name + "." + std::to_string(i);
      places[number] = {std::max(item.line, 1), std::max(item.column, 1)};
      note_places(item, number, places);
    }
  }
}

}  // namespace

Place PatchSpec::place_of(std::string_view path) const {
  for (;;) {
    if (const auto found = places.find(path); found != places.end()) return found->second;
    if (path.empty()) return {};
    const std::size_t dot = path.rfind('.');
    path = path.substr(0, dot == std::string_view::npos ? 0 : dot);
  }
}

PatchTables::PatchTables(const base::Node& root, const std::string& source_name, FileShelf& shelf)
    : root_(root), source_(source_name), shelf_(shelf) {
  patch_.source_name = source_name;
  patch_.places[""] = {std::max(root_.line, 1), std::max(root_.column, 1)};
  note_places(root_, "", patch_.places);
}

void PatchTables::fail_at(int line, int column, ErrorCode code, std::string message) {
  Error error = fail(code, std::move(message));
  error.source = source_;
  error.line = std::max(line, 1);
  error.column = std::max(column, 1);
  keep(error);
}

void PatchTables::read_common(TableReader& top) {
  for (const char* section :
       {"format", "kind", "curves", "surfaces", "envelopes", "lfos", "maps"}) {
    top.node(section);
  }
  patch_.name = read_text_line(top, "name");
  patch_.about = read_text_line(top, "about");
  patch_.mode = static_cast<PlayMode>(
      top.choice("mode", static_cast<int>(patch_.mode), {"poly", "mono", "legato"}));
  patch_.priority = static_cast<NotePriority>(top.choice("priority", 0, {"last", "low", "high"}));
  const Node* seed = top.node("seed");
  if (seed != nullptr && (seed->kind != Node::Kind::integer || seed->integer < 0)) {
    top.fail_at(*seed, ErrorCode::wrong_type, "seed must be a whole number from 0");
  } else if (seed != nullptr) {
    patch_.seed = static_cast<std::uint64_t>(seed->integer);
  }
}

void PatchTables::read_curves() {
  auto set = curves::read_curve_tables(root_, source_, [this](const std::string& path) {
    return shelf_.curves(FileShelf::beside(source_, path));
  });
  if (!set) return keep(set.error());
  patch_.curves = std::move(*set);
  for (const char* section : {"curves", "surfaces"}) {
    const Node* tables = root_.find(section);
    for (const std::string_view builtin : dsp::builtin_wave_names()) {
      if (tables == nullptr || tables->find(builtin) == nullptr) continue;
      const Node& at = *tables->find(builtin);
      fail_at(at.line, at.column, ErrorCode::duplicate_name,
              "the name '" + std::string(builtin) + "' is that of a built-in curve");
    }
  }
}

std::vector<std::string_view> PatchTables::curve_words(bool with_surfaces) const {
  const auto builtin = dsp::builtin_wave_names();
  std::vector<std::string_view> words(builtin.begin(), builtin.end());
  for (const auto& curve : patch_.curves.curves) words.push_back(curve.name());
  if (!with_surfaces) return words;
  for (const auto& surface : patch_.curves.surfaces) words.push_back(surface.name());
  return words;
}

const curves::NurbsCurve* PatchTables::find_curve(const std::string& name) {
  if (const auto* drawn = patch_.curves.find_curve(name)) return drawn;
  if (!dsp::is_builtin_wave(name)) return nullptr;
  patch_.curves.curves.push_back(dsp::builtin_curve(name).value());
  return &patch_.curves.curves.back();
}

std::string PatchTables::curve_name(TableReader& reader, std::string_view key, Role role) {
  const Node* at = reader.node(key);
  std::string name = reader.string(key, "");
  if (at == nullptr || !reader.ok()) return "";
  if (const auto* curve = find_curve(name)) {
    check_role(reader, *at, *curve, role);
    return name;
  }
  if (const auto* surface = patch_.curves.find_surface(name)) {
    if (role != Role::wave) {
      reader.fail_at(*at, ErrorCode::unknown_name,
                     "'" + name + "' is a surface; a curve is needed here");
    } else if (surface->dim() > 2) {
      reader.fail_at(*at, ErrorCode::not_scalar,
                     "the points of surface '" + name + "' have " + std::to_string(surface->dim()) +
                         " coordinates; a wave has 1 or 2");
    }
    return name;
  }
  const auto synonyms = role == Role::wave ? std::span<const base::Synonym>(kWaveSynonyms)
                                           : std::span<const base::Synonym>();
  reader.fail_at(*at, ErrorCode::unknown_name,
                 "there is no curve '" + name + "'" +
                     base::suggestion(name, curve_words(role == Role::wave), synonyms));
  return "";
}

void PatchTables::check_role(TableReader& reader, const Node& at, const curves::NurbsCurve& curve,
                             Role role) {
  if (curve.dim() > 2) {
    reader.fail_at(at, ErrorCode::not_scalar,
                   "the points of curve '" + curve.name() + "' have " +
                       std::to_string(curve.dim()) + " coordinates; 1 or 2 are possible here");
  } else if (role == Role::function && curve.dim() == 2 && !curves::is_non_decreasing(curve, 0)) {
    reader.fail_at(at, ErrorCode::not_a_function,
                   "curve '" + curve.name() + "' goes back in x, so it is no function of it");
  }
}

std::vector<const base::Node::Member*> PatchTables::named_tables(std::string_view section,
                                                                 int most) {
  std::vector<const Node::Member*> tables;
  const Node* node = root_.find(section);
  if (node == nullptr) return tables;
  const std::string what(section);
  if (node->kind != Node::Kind::table) {
    fail_at(node->line, node->column, ErrorCode::wrong_type,
            what + " must hold named tables: [" + what + ".NAME]");
    return tables;
  }
  for (const Node::Member& member : node->members) {
    if (member.value.kind != Node::Kind::table) {
      std::string message = what;
      message.append(" must hold named tables: [").append(what).append(".");
      message.append(member.key).append("]");
      fail_at(member.line, member.column, ErrorCode::wrong_type, std::move(message));
    } else if (!curves::is_valid_name(member.key)) {
      fail_at(member.line, member.column, ErrorCode::malformed,
              what + ": '" + member.key + "': a name is 1 to 64 letters, digits, '_' and '-'");
    } else if (static_cast<int>(tables.size()) == most) {
      fail_at(member.line, member.column, ErrorCode::value_out_of_range,
              what + ": '" + member.key + "' is one more than the " + std::to_string(most) +
                  " a patch may have");
    }
    if (!ok()) return {};
    tables.push_back(&member);
  }
  return tables;
}

std::vector<const base::Node*> PatchTables::tables_of(std::string_view section, const char* what,
                                                      int most) {
  TableReader top(root_, source_, "patch");
  const Node* array = top.array(section);
  std::vector<const Node*> tables;
  if (!top.ok()) keep(top.finish());
  if (!ok() || array == nullptr) return tables;
  const std::string one(what);
  for (const Node& table : array->items) {
    if (table.kind != Node::Kind::table) {
      fail_at(table.line, table.column, ErrorCode::wrong_type,
              one + " must be a table: [[" + std::string(section) + "]]");
      return {};
    }
    if (static_cast<int>(tables.size()) == most) {
      fail_at(table.line, table.column, ErrorCode::value_out_of_range,
              "this " + one.substr(one.find(' ') + 1) + " is one more than the " +
                  std::to_string(most) + " a patch may have");
      return {};
    }
    tables.push_back(&table);
  }
  return tables;
}

void PatchTables::exclude(TableReader& reader, const char* one, const char* other) {
  const Node* second = reader.node(other);
  if (reader.node(one) == nullptr || second == nullptr) return;
  reader.fail_at(*second, ErrorCode::malformed,
                 std::string("'") + one + "' and '" + other + "' exclude each other");
}

}  // namespace knotwave::engine
