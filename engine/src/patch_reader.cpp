// SPDX-License-Identifier: MIT
// A patch's own keys, its tuning, and the names of curves in their roles.
#include "patch_reader.h"

#include <algorithm>
#include <limits>

#include "knotwave/base/suggest.h"
#include "knotwave/curves/algorithms.h"
#include "knotwave/dsp/builtin_waves.h"

#include "patch_words.h"

namespace knotwave::engine {

Result<PatchSpec> read_patch(const base::Node& root, const std::string& source_name,
                             FileShelf& shelf) {
  return PatchReader(root, source_name, shelf).read();
}

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

Result<PatchSpec> PatchReader::read() {
  patch_.places[""] = {std::max(root_.line, 1), std::max(root_.column, 1)};
  note_places(root_, "", patch_.places);
  using Section = void (PatchReader::*)();
  // Top first, so that a misspelt section is named before what misses it; maps name all others.
  constexpr Section kSections[] = {
      &PatchReader::read_top,    &PatchReader::read_envelopes, &PatchReader::read_oscillators,
      &PatchReader::read_noise,  &PatchReader::read_lfos,      &PatchReader::read_crossfade,
      &PatchReader::read_shaper, &PatchReader::read_filter,    &PatchReader::read_maps};
  for (const Section section : kSections) {
    if (ok()) (this->*section)();
  }
  if (error_) return *error_;
  return std::move(patch_);
}

void PatchReader::fail_at(int line, int column, ErrorCode code, std::string message) {
  Error error = fail(code, std::move(message));
  error.source = source_;
  error.line = std::max(line, 1);
  error.column = std::max(column, 1);
  keep(error);
}

void PatchReader::read_top() {
  TableReader top(root_, source_, "patch");
  for (const char* section : {"format", "kind", "curves", "surfaces", "oscillators", "noise",
                              "crossfade", "shaper", "filter", "envelopes", "lfos", "maps"}) {
    top.node(section);
  }
  patch_.name = top.string("name", "");
  patch_.about = top.string("about", "");
  patch_.gain_db = top.number("gain_db", patch_.gain_db, -96, 24);
  patch_.pan = top.number("pan", patch_.pan, 0, 1);
  patch_.polyphony = top.integer("polyphony", patch_.polyphony, 1, 128);
  patch_.mode = static_cast<PlayMode>(top.choice("mode", 0, {"poly", "mono", "legato"}));
  patch_.priority = static_cast<NotePriority>(top.choice("priority", 0, {"last", "low", "high"}));
  patch_.glide_s = top.number("glide_s", patch_.glide_s, 0, 60);
  patch_.bend_semitones = top.number("bend_semitones", patch_.bend_semitones, 0, 96);
  patch_.velocity_db = top.number("velocity_db", patch_.velocity_db, 0, 96);
  const Node* seed = top.node("seed");
  if (seed != nullptr && (seed->kind != Node::Kind::integer || seed->integer < 0)) {
    top.fail_at(*seed, ErrorCode::wrong_type, "seed must be a whole number from 0");
  } else if (seed != nullptr) {
    patch_.seed = static_cast<std::uint64_t>(seed->integer);
  }
  const Node* glide = top.node("glide_curve");
  read_tuning(top);
  keep(top.finish());
  if (!ok()) return;
  read_curves();
  if (!ok() || glide == nullptr) return;
  TableReader again(root_, source_, "patch");
  patch_.glide_curve = curve_name(again, "glide_curve", Role::function);
  if (!again.ok()) keep(again.finish());
}

void PatchReader::read_curves() {
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

void PatchReader::read_tuning(TableReader& top) {
  std::string texts[2];
  std::string* paths[2] = {&patch_.tuning_file, &patch_.keymap_file};
  const char* keys[2] = {"tuning", "keymap"};
  for (int i = 0; i < 2; ++i) {
    const Node* at = top.node(keys[i]);
    const std::string name = top.string(keys[i], "");
    if (at == nullptr || !top.ok()) continue;
    *paths[i] = FileShelf::beside(source_, name);
    auto text = shelf_.read(*paths[i]);
    if (!text) return top.fail_at(*at, text.error().code, text.error().message);
    // A file that was asked for and is empty is a fault, not a default.
    texts[i] = text->empty() ? "\n" : std::move(*text);
  }
  if (!top.ok()) return;
  auto tuning = Tuning::create(texts[0], patch_.tuning_file, texts[1], patch_.keymap_file);
  if (!tuning) return keep(tuning.error());
  patch_.tuning = *tuning;
}

std::vector<std::string_view> PatchReader::curve_words(bool with_surfaces) const {
  const auto builtin = dsp::builtin_wave_names();
  std::vector<std::string_view> words(builtin.begin(), builtin.end());
  for (const auto& curve : patch_.curves.curves) words.push_back(curve.name());
  if (!with_surfaces) return words;
  for (const auto& surface : patch_.curves.surfaces) words.push_back(surface.name());
  return words;
}

const curves::NurbsCurve* PatchReader::find_curve(const std::string& name) {
  if (const auto* drawn = patch_.curves.find_curve(name)) return drawn;
  if (!dsp::is_builtin_wave(name)) return nullptr;
  patch_.curves.curves.push_back(dsp::builtin_curve(name).value());
  return &patch_.curves.curves.back();
}

std::string PatchReader::curve_name(TableReader& reader, std::string_view key, Role role) {
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

void PatchReader::check_role(TableReader& reader, const Node& at, const curves::NurbsCurve& curve,
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

std::vector<const base::Node::Member*> PatchReader::named_tables(std::string_view section,
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

}  // namespace knotwave::engine
