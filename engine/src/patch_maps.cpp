// SPDX-License-Identifier: MIT
// Maps: from a source, through a curve or surface, to a target.
#include <algorithm>
#include <charconv>

#include "knotwave/base/suggest.h"
#include "knotwave/dsp/builtin_waves.h"

#include "patch_tables.h"
#include "patch_words.h"

namespace knotwave::engine {
namespace {

// How far one map may move its target, in the target's unit.
double most_depth(MapTarget target) {
  switch (target) {
    case MapTarget::amp:
    case MapTarget::level:
    case MapTarget::drive:
    case MapTarget::pitch:
    case MapTarget::cutoff:
      return 240;  // dB, semitones
    case MapTarget::lfo_rate:
    case MapTarget::envelope_time:
      return 20;  // octaves
    default:
      return 1000;
  }
}

std::string why_no_source(const PatchSpec& patch, std::string_view word) {
  if (is_controller_word(word)) return "; controllers are cc0 to cc119";
  std::string suggestion = source_suggestion(patch, word);
  if (!suggestion.empty() || !word.starts_with(kFreePrefix)) return suggestion;
  return "; a free number is there once a map has it as its target: to = \"" + std::string(word) +
         "\"";
}

std::vector<std::string_view> split_at_dots(std::string_view text) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t dot = text.find('.');
    parts.push_back(text.substr(0, dot));
    if (dot == std::string_view::npos) return parts;
    text.remove_prefix(dot + 1);
  }
}

int whole_number(std::string_view text) {
  int number = -1;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  return status == std::errc{} && end == text.data() + text.size() ? number : -1;
}

// Targets that are there with a section of the patch.
bool is_section_word(std::string_view word) {
  return word == "noise" || word == "filter" || word == "shaper" || word == "crossfade";
}

// x, y, z, w as 0 to 3; no word is 0.
int coordinate_index(std::string_view word) {
  constexpr std::string_view kWords = "xyzw";
  if (word.size() != 1) return -1;
  const std::size_t found = kWords.find(word);
  return found == std::string_view::npos ? -1 : static_cast<int>(found);
}

// Knots as the file counts them; those at the ends stay.
bool check_knot_index(base::TableReader& reader, const base::Node& at,
                      const curves::NurbsCurve& curve, int index, std::string_view word) {
  const int outer = curve.is_periodic() ? 0 : curve.degree();
  const int first = outer + 1, last = static_cast<int>(curve.spec().knots.size()) - outer - 2;
  if (index >= first && index <= last) return true;
  reader.fail_at(at, ErrorCode::parameter_out_of_range,
                 "curve '" + curve.name() + "' has " +
                     (last < first ? "no inner knots"
                                   : "the inner knots " + std::to_string(first) + " to " +
                                         std::to_string(last)) +
                     ", there is no inner knot '" + std::string(word) + "'");
  return false;
}

}  // namespace

void PatchTables::read_maps() {
  const std::vector<const Node*> tables = tables_of("maps", "a map", kMaxMaps);
  if (!ok() || tables.empty()) return;
  collect_free_numbers(*root_.find("maps"));
  int number = 0;
  for (const Node* table : tables) {
    if (ok()) read_map(*table, ++number);
  }
}

// A free number is there because a map moves it; maps before that one may read it.
void PatchTables::collect_free_numbers(const Node& maps) {
  for (const Node& table : maps.items) {
    const Node* to = table.kind == Node::Kind::table ? table.find("to") : nullptr;
    if (to == nullptr || to->kind != Node::Kind::string || !to->text.starts_with(kFreePrefix))
      continue;
    const std::string name = to->text.substr(kFreePrefix.size());
    std::vector<std::string>& known = patch_.free_numbers;
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    if (!curves::is_valid_name(name)) {
      return fail_at(to->line, to->column, ErrorCode::malformed,
                     "'" + to->text + "': a name is 1 to 64 letters, digits, '_' and '-'");
    }
    if (static_cast<int>(known.size()) == kMaxFreeNumbers) {
      return fail_at(to->line, to->column, ErrorCode::value_out_of_range,
                     "'" + to->text + "' is one more than the " + std::to_string(kMaxFreeNumbers) +
                         " free numbers a patch may have");
    }
    known.push_back(name);
  }
}

void PatchTables::read_map(const Node& table, int number) {
  TableReader reader(table, source_, "map " + std::to_string(number));
  MapSpec map;
  read_map_sources(reader, map);
  read_map_target(reader, map);
  map.smooth_s = reader.number("smooth_s", map.smooth_s, 0, 10);
  map.enabled = reader.boolean("enabled", true);
  if (moves_a_number(map)) {
    const double least =
        map.target == MapTarget::curve_weight ? curves::kMinWeight : -curves::kMaxCoordinate;
    map.low = reader.number("low", least, curves::kMaxCoordinate);
    map.high = reader.number("high", least, curves::kMaxCoordinate);
    if (reader.ok() && !(map.low < map.high)) {
      reader.fail_at(*reader.node("low"), ErrorCode::value_out_of_range,
                     "low (" + base::number_text(map.low) + ") must be below high (" +
                         base::number_text(map.high) + "); a falling curve turns a map round");
    }
  } else {
    const double most = most_depth(map.target);
    map.depth = reader.number("depth", 1, -most, most);
  }
  keep(reader.finish());
  patch_.maps.push_back(std::move(map));
}

void PatchTables::read_map_sources(TableReader& reader, MapSpec& map) {
  const Node* from = reader.node("from");
  std::vector<const Node*> words;
  if (from != nullptr && from->kind == Node::Kind::array) {
    for (const Node& item : from->items) words.push_back(&item);
  } else {
    reader.string("from");  // required
    if (from != nullptr) words.push_back(from);
  }
  if (!reader.ok()) return;
  const Node* surface = reader.node("surface");
  if (words.size() != (surface != nullptr ? 2u : 1u)) {
    return reader.fail_at(*from, ErrorCode::dimension_mismatch,
                          surface != nullptr
                              ? "a map with a surface is from two sources: from = [\"a\", \"b\"]"
                              : "a map without a surface is from one source");
  }
  SourceWord found[2];
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto source =
        words[i]->kind == Node::Kind::string ? find_source(patch_, words[i]->text) : std::nullopt;
    if (!source) {
      return reader.fail_at(
          *words[i], ErrorCode::unknown_name,
          "there is no source '" + words[i]->text + "'" + why_no_source(patch_, words[i]->text));
    }
    found[i] = *source;
  }
  map.source = found[0].source;
  map.source_index = found[0].index;
  map.source_v = found[1].source;
  map.source_v_index = found[1].index;
  map.curve = curve_name(reader, "curve", Role::function);
  map.surface = reader.string("surface", "");
  if (surface == nullptr || !reader.ok()) return;
  if (reader.node("curve") != nullptr) {
    return reader.fail_at(*surface, ErrorCode::malformed,
                          "'curve' and 'surface' exclude each other");
  }
  const auto* shape = patch_.curves.find_surface(map.surface);
  if (shape == nullptr) {
    std::vector<std::string_view> names;
    for (const auto& known : patch_.curves.surfaces) names.push_back(known.name());
    return reader.fail_at(
        *surface, ErrorCode::unknown_name,
        "there is no surface '" + map.surface + "'" + base::suggestion(map.surface, names));
  }
  if (shape->dim() != 1) {
    reader.fail_at(*surface, ErrorCode::not_scalar,
                   "the points of surface '" + map.surface + "' have " +
                       std::to_string(shape->dim()) + " coordinates; a map needs 1");
  }
}

void PatchTables::read_map_target(TableReader& reader, MapSpec& map) {
  const std::string word = reader.string("to");
  const Node* at = reader.node("to");
  if (!reader.ok()) return;
  if (word.starts_with("curve.")) return read_curve_target(reader, *at, map);
  const auto target = find_target(patch_, word);
  if (!target) {
    return reader.fail_at(*at, ErrorCode::unknown_name,
                          "there is no target '" + word + "' in this patch" + why_no_target(word));
  }
  map.target = target->target;
  map.target_index = target->index;
}

std::string PatchTables::why_no_target(const std::string& word) const {
  const std::string section = word.substr(0, word.find('.'));
  const bool is_silent_word = section == "free" || section == "lfo" || section == "envelope";
  if (!patch_.has_sound && !is_silent_word) {
    return ", which has no oscillators and no sound: a map moves free.NAME, envelope.NAME.time, "
           "lfo.NAME.rate or a number of a curve";
  }
  if (is_section_word(section) && root_.find(section) == nullptr) {
    return ", which has no [" + section + "]";
  }
  return target_suggestion(patch_, word);
}

// curve.NAME.weight.I, curve.NAME.point.I, curve.NAME.point.I.x or curve.NAME.knot.K
void PatchTables::read_curve_target(TableReader& reader, const Node& at, MapSpec& map) {
  const auto parts = split_at_dots(at.text);
  const bool weight = parts.size() == 4 && parts[2] == "weight";
  const bool knot = parts.size() == 4 && parts[2] == "knot";
  const bool point = (parts.size() == 4 || parts.size() == 5) && parts[2] == "point";
  if (!weight && !point && !knot) {
    return reader.fail_at(at, ErrorCode::unknown_name,
                          "'" + at.text +
                              "' is no target: write curve.NAME.weight.2, curve.NAME.point.2, "
                              "curve.NAME.point.2.y or curve.NAME.knot.4");
  }
  map.target = weight ? MapTarget::curve_weight
               : knot ? MapTarget::curve_knot
                      : MapTarget::curve_point;
  map.target_curve = parts[1];
  if (dsp::is_builtin_wave(map.target_curve)) {
    return reader.fail_at(at, ErrorCode::unsupported,
                          "'" + map.target_curve + "' is built in; draw a curve to move it");
  }
  const curves::NurbsCurve* curve = find_curve(map.target_curve);
  if (curve == nullptr) {
    return reader.fail_at(at, ErrorCode::unknown_name,
                          "there is no curve '" + map.target_curve + "'" +
                              base::suggestion(map.target_curve, curve_words(false)));
  }
  if (curve->degree() > curves::kMaxPieceDegree) {
    return reader.fail_at(at, ErrorCode::unsupported,
                          "curve '" + curve->name() + "' has degree " +
                              std::to_string(curve->degree()) +
                              "; a map can move curves of degree " +
                              std::to_string(curves::kMaxPieceDegree) + " at most");
  }
  const int points = curve->point_count() - (curve->is_periodic() ? curve->degree() : 0);
  map.target_point = whole_number(parts[3]);
  if (knot) {
    if (!check_knot_index(reader, at, *curve, map.target_point, parts[3])) return;
    return check_control_conflict(reader, at, map);
  }
  if (map.target_point < 0 || map.target_point >= points) {
    return reader.fail_at(at, ErrorCode::parameter_out_of_range,
                          "curve '" + curve->name() + "' has the points 0 to " +
                              std::to_string(points - 1) + ", there is no point '" +
                              std::string(parts[3]) + "'");
  }
  map.target_coordinate = parts.size() == 5 ? coordinate_index(parts[4]) : 0;
  if (map.target_coordinate < 0 || map.target_coordinate >= curve->dim()) {
    return reader.fail_at(at, ErrorCode::parameter_out_of_range,
                          "the points of curve '" + curve->name() + "' have " +
                              std::to_string(curve->dim()) +
                              (curve->dim() == 1 ? " coordinate" : " coordinates") +
                              ", there is no '" + std::string(parts[4]) + "'");
  }
  check_control_conflict(reader, at, map);
}

// A number has one controller; a point and its weight multiply, so only one of them may move.
void PatchTables::check_control_conflict(TableReader& reader, const Node& at, const MapSpec& map) {
  int controls = 0;
  for (std::size_t i = 0; i < patch_.maps.size(); ++i) {
    const MapSpec& other = patch_.maps[i];
    if (!moves_a_number(other) || other.target_curve != map.target_curve) continue;
    ++controls;
    const bool same_kind = other.target == map.target;
    if (other.target_point != map.target_point) continue;
    const bool has_knot =
        map.target == MapTarget::curve_knot || other.target == MapTarget::curve_knot;
    if (has_knot && !same_kind) continue;
    if (same_kind && other.target_coordinate != map.target_coordinate) continue;
    return reader.fail_at(at, ErrorCode::control_conflict,
                          "map " + std::to_string(i + 1) + " moves " +
                              (same_kind ? "it already"
                                         : "the weight or a coordinate of the same point, and the "
                                           "two would multiply"));
  }
  if (controls >= curves::kMaxControls) {
    reader.fail_at(at, ErrorCode::control_conflict,
                   "curve '" + map.target_curve + "' is moved in " +
                       std::to_string(curves::kMaxControls) + " places already, which is the most");
  }
}

}  // namespace knotwave::engine
