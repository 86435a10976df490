// SPDX-License-Identifier: MIT
// The sections of a patch that make its sound.
#include <algorithm>
#include <filesystem>

#include "knotwave/base/suggest.h"

#include "patch_reader.h"
#include "patch_words.h"

namespace knotwave::engine {
namespace {

constexpr int kMinWaveFrame = 4, kMaxWaveFrame = 65536;  // what io reads as a cycle

void check_wave_file(base::TableReader& reader, const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  const base::Node& place = *reader.node("wave_file");
  if (status.type() == fs::file_type::not_found) {
    reader.fail_at(place, ErrorCode::file_not_found, "there is no file '" + path + "'");
  } else if (failed) {
    reader.fail_at(place, ErrorCode::io_failed,
                   "cannot look at '" + path + "': " + failed.message());
  } else if (status.type() != fs::file_type::regular) {
    const bool is_folder = status.type() == fs::file_type::directory;
    reader.fail_at(place, ErrorCode::io_failed,
                   "'" + path + (is_folder ? "' is a folder" : "' is a device or pipe") +
                       ", not a regular file");
  }
}

}  // namespace

void PatchReader::check_envelope_name(TableReader& reader, const std::string& name) {
  if (name.empty() || has_name(patch_.envelopes, name)) return;
  reader.fail_at(
      *reader.node("envelope"), ErrorCode::unknown_name,
      "there is no envelope '" + name + "'" + base::suggestion(name, names_of(patch_.envelopes)));
}

void PatchReader::require_amp() {
  if (!ok() || has_name(patch_.envelopes, "amp")) return;
  fail_at(root_.line, root_.column, ErrorCode::missing_key,
          "the patch has no [envelopes.amp], the loudness of a note" +
              base::suggestion("amp", names_of(patch_.envelopes)));
}

void PatchReader::read_oscillators() {
  for (const Node::Member* member : named_tables("oscillators", kMaxOscillators)) {
    if (is_target_word(member->key)) {
      return fail_at(member->line, member->column, ErrorCode::duplicate_name,
                     "an oscillator may not be called '" + member->key +
                         "': maps use that word for something else");
    }
    read_oscillator(*member);
    if (!ok()) return;
  }
  if (ok() && patch_.oscillators.empty() && root_.find("noise") == nullptr) {
    fail_at(root_.line, root_.column, ErrorCode::missing_key,
            "the patch has no source; it needs an [oscillators.NAME] or [noise]");
  }
}

void PatchReader::read_oscillator(const Node::Member& member) {
  TableReader reader(member.value, source_, "oscillator '" + member.key + "'");
  OscillatorSpec spec;
  spec.name = member.key;
  exclude(reader, "wave", "wave_file");
  if (reader.node("wave") == nullptr && reader.node("wave_file") == nullptr) {
    reader.fail_at(member.value, ErrorCode::missing_key, "'wave' (or 'wave_file') is missing");
  }
  spec.wave = curve_name(reader, "wave", Role::wave);
  if (const std::string file = reader.string("wave_file", ""); reader.node("wave_file")) {
    spec.wave_file = FileShelf::beside(source_, file);
    if (reader.ok()) check_wave_file(reader, spec.wave_file);
  }
  spec.wave_frame = reader.integer("wave_frame", 0, kMinWaveFrame, kMaxWaveFrame);
  if (reader.node("wave_frame") != nullptr && reader.node("wave_file") == nullptr) {
    reader.fail_at(*reader.node("wave_frame"), ErrorCode::malformed,
                   "'wave_frame' needs a 'wave_file'");
  }
  spec.level_db = reader.number("level_db", spec.level_db, -120, 24);
  spec.transpose_semitones = reader.number("transpose", 0, -96, 96);
  spec.detune_cents = reader.number("detune_cents", 0, -1200, 1200);
  spec.ratio = reader.number("ratio", 1, 0.01, 100);
  spec.fixed_hz = reader.number("fixed_hz", 0, 0.001, 100'000);
  for (const char* key : {"transpose", "detune_cents", "ratio"}) exclude(reader, "fixed_hz", key);
  spec.position = reader.number("position", spec.position, 0, 1);
  if (const Node* phase = reader.node("phase"); phase && phase->kind == Node::Kind::string) {
    spec.random_phase = reader.choice("phase", 0, {"random"}) == 0;
  } else {
    spec.phase_cycles = reader.number("phase", 0, 0, 1);
  }
  spec.pan = reader.number("pan", spec.pan, 0, 1);
  spec.envelope = reader.string("envelope", "");
  check_envelope_name(reader, spec.envelope);
  keep(reader.finish());
  patch_.oscillators.push_back(std::move(spec));
}

void PatchReader::read_noise() {
  TableReader top(root_, source_, "patch");
  const Node* table = top.table("noise");
  if (!top.ok()) return keep(top.finish());
  if (table == nullptr) return;
  TableReader reader(*table, source_, "noise");
  patch_.noise_db = reader.number("level_db", 0, -120, 24);
  patch_.noise_pan = reader.number("pan", 0.5, 0, 1);
  patch_.noise_envelope = reader.string("envelope", "");
  check_envelope_name(reader, patch_.noise_envelope);
  keep(reader.finish());
}

void PatchReader::read_crossfade() {
  TableReader top(root_, source_, "patch");
  const Node* table = top.table("crossfade");
  if (!top.ok()) return keep(top.finish());
  if (table == nullptr) return;
  TableReader reader(*table, source_, "crossfade");
  patch_.crossfade_on = true;
  std::vector<std::string_view> names = names_of(patch_.oscillators);
  if (patch_.noise_db > kNoiseOffDb) names.push_back("noise");
  const Node* between = reader.array("between");
  if (between == nullptr || between->items.size() != 2) {
    reader.fail_at(between == nullptr ? *table : *between, ErrorCode::missing_key,
                   "'between' must name two sources: between = [\"a\", \"b\"]");
    return keep(reader.finish());
  }
  int* const ends[2] = {&patch_.crossfade_a, &patch_.crossfade_b};
  for (std::size_t i = 0; i < 2 && reader.ok(); ++i) {
    const Node& at = between->items[i];
    const auto found = at.kind == Node::Kind::string
                           ? std::find(names.begin(), names.end(), at.text)
                           : names.end();
    if (found == names.end()) {
      reader.fail_at(at, ErrorCode::unknown_name,
                     "there is no oscillator '" + at.text + "'" + base::suggestion(at.text, names));
      break;
    }
    *ends[i] = *found == "noise" ? kMaxOscillators : static_cast<int>(found - names.begin());
  }
  if (reader.ok() && patch_.crossfade_a == patch_.crossfade_b) {
    reader.fail_at(between->items[1], ErrorCode::duplicate_name,
                   "a crossfade is between two different sources");
  }
  patch_.crossfade_position = reader.number("position", 0.5, 0, 1);
  patch_.crossfade_law = reader.string("law", "equal_power");
  if (patch_.crossfade_law == "equal_power") {
    patch_.crossfade_law.clear();
  } else if (patch_.crossfade_law != "linear") {
    patch_.crossfade_law = curve_name(reader, "law", Role::law);
  }
  keep(reader.finish());
}

void PatchReader::read_shaper() {
  TableReader top(root_, source_, "patch");
  const Node* table = top.table("shaper");
  if (!top.ok()) return keep(top.finish());
  if (table == nullptr) return;
  TableReader reader(*table, source_, "shaper");
  reader.string("curve");  // required
  patch_.shaper_curve = curve_name(reader, "curve", Role::function);
  patch_.shaper_drive_db = reader.number("drive_db", 0, -60, 60);
  patch_.shaper_mix = reader.number("mix", 1, 0, 1);
  keep(reader.finish());
}

void PatchReader::read_filter() {
  TableReader top(root_, source_, "patch");
  const Node* table = top.table("filter");
  if (!top.ok()) return keep(top.finish());
  if (table == nullptr) return;
  TableReader reader(*table, source_, "filter");
  patch_.filter_on = true;
  constexpr dsp::FilterKind kKinds[] = {dsp::FilterKind::low, dsp::FilterKind::band,
                                        dsp::FilterKind::high, dsp::FilterKind::notch};
  patch_.filter_kind = kKinds[reader.choice("kind", 0, {"low", "band", "high", "notch"})];
  patch_.filter_cutoff_hz = reader.number("cutoff_hz", patch_.filter_cutoff_hz, 5, 100'000);
  patch_.filter_resonance = reader.number("resonance", 0, 0, 1);
  patch_.filter_key_track = reader.number("key_track", 0, -4, 4);
  keep(reader.finish());
}

}  // namespace knotwave::engine
