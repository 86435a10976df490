// SPDX-License-Identifier: MIT
// The sections of a patch but for its maps.
#include <filesystem>

#include "knotwave/base/suggest.h"

#include "patch_reader.h"
#include "patch_words.h"

namespace knotwave::engine {
namespace {

constexpr double kMostSeconds = 3600;
constexpr double kMostBeats = 1024;
constexpr int kMinWaveFrame = 4, kMaxWaveFrame = 65536;  // what io reads as a cycle

template <class Item>
std::vector<std::string_view> names_of(const std::vector<Item>& items) {
  std::vector<std::string_view> names;
  names.reserve(items.size());
  for (const Item& item : items) names.push_back(item.name);
  return names;
}

template <class Item>
bool has_name(const std::vector<Item>& items, std::string_view name) {
  for (const Item& item : items) {
    if (item.name == name) return true;
  }
  return false;
}

// Two keys that say the same thing in two ways.
void exclude(base::TableReader& reader, const char* one, const char* other) {
  const base::Node* second = reader.node(other);
  if (reader.node(one) == nullptr || second == nullptr) return;
  reader.fail_at(*second, ErrorCode::malformed,
                 std::string("'") + one + "' and '" + other + "' exclude each other");
}

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

void PatchReader::read_envelopes() {
  for (const Node::Member* member : named_tables("envelopes", kMaxEnvelopes)) {
    if (is_source_word(member->key)) {
      return fail_at(member->line, member->column, ErrorCode::duplicate_name,
                     "an envelope may not be called '" + member->key +
                         "': maps use that word for something else");
    }
    read_envelope(*member);
    if (!ok()) return;
  }
  if (!ok() || has_name(patch_.envelopes, "amp")) return;
  fail_at(root_.line, root_.column, ErrorCode::missing_key,
          "the patch has no [envelopes.amp], the loudness of a note" +
              base::suggestion("amp", names_of(patch_.envelopes)));
}

void PatchReader::read_envelope(const Node::Member& member) {
  TableReader reader(member.value, source_, "envelope '" + member.key + "'");
  EnvelopeUse use;
  use.name = member.key;
  reader.string("curve");  // required
  use.curve = curve_name(reader, "curve", Role::function);
  exclude(reader, "seconds", "beats");
  use.tempo_beats = reader.node("beats") != nullptr;
  use.spec.seconds = use.tempo_beats ? reader.number("beats", 1, 1e-4, kMostBeats)
                                     : reader.number("seconds", 1, 1e-4, kMostSeconds);
  read_envelope_places(reader, use);
  use.spec.retrigger = reader.choice("retrigger", 0, {"current", "restart"}) == 0
                           ? dsp::EnvelopeSpec::Retrigger::current
                           : dsp::EnvelopeSpec::Retrigger::restart;
  use.velocity_time = reader.number("velocity_time", 0, -10, 10);
  use.key_time = reader.number("key_time", 0, -10, 10);
  keep(reader.finish());
  patch_.envelopes.push_back(std::move(use));
}

// Where an envelope holds, repeats and goes on: parameters of its curve (of 2-D curves, times).
void PatchReader::read_envelope_places(TableReader& reader, EnvelopeUse& use) {
  const curves::NurbsCurve* curve = patch_.curves.find_curve(use.curve);
  double low = 0;
  double high = 1;
  if (curve != nullptr) {
    low = curve->u_min();
    high = curve->u_max();
    double ends[2][curves::kMaxDim] = {};
    if (curve->dim() == 2) {
      curve->evaluate(low, ends[0]);
      curve->evaluate(high, ends[1]);
      low = ends[0][0];
      high = ends[1][0];
    }
  }
  const double none = low - 1;
  use.spec.sustain_u = reader.number("sustain_at", none, low, high);
  use.spec.release_u = reader.number("release_at", none, low, high);
  use.spec.loop_start_u = use.spec.loop_end_u = low;
  exclude(reader, "sustain_at", "loop");
  const Node* release = reader.node("release_at");
  if (reader.node("sustain_at") != nullptr && release != nullptr && reader.ok() &&
      use.spec.release_u < use.spec.sustain_u) {
    reader.fail_at(*release, ErrorCode::parameter_out_of_range,
                   "release_at (" + base::number_text(use.spec.release_u) +
                       ") is before sustain_at (" + base::number_text(use.spec.sustain_u) + ")");
  }
  const Node* loop = reader.array("loop");
  const std::vector<double> ends = reader.numbers("loop");
  if (loop == nullptr || !reader.ok()) return;
  if (ends.size() != 2 || !(ends[0] < ends[1])) {
    return reader.fail_at(*loop, ErrorCode::parameter_out_of_range,
                          "loop must be two rising places of the curve: [start, end]");
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (ends[i] >= low && ends[i] <= high) continue;
    return reader.fail_at(loop->items[i], ErrorCode::parameter_out_of_range,
                          "the loop place " + base::number_text(ends[i]) +
                              " is outside the curve's " + base::number_text(low) + " to " +
                              base::number_text(high));
  }
  use.spec.loop_start_u = ends[0];
  use.spec.loop_end_u = ends[1];
  if (release != nullptr && use.spec.release_u < ends[1]) {
    reader.fail_at(*release, ErrorCode::parameter_out_of_range,
                   "release_at (" + base::number_text(use.spec.release_u) +
                       ") is before the end of the loop (" + base::number_text(ends[1]) + ")");
  }
}

void PatchReader::read_lfos() {
  for (const Node::Member* member : named_tables("lfos", kMaxLfos)) {
    if (is_source_word(member->key) || has_name(patch_.envelopes, member->key)) {
      return fail_at(
          member->line, member->column, ErrorCode::duplicate_name,
          "an LFO may not be called '" + member->key + "': maps use that word for something else");
    }
    read_lfo(*member);
    if (!ok()) return;
  }
}

void PatchReader::read_lfo(const Node::Member& member) {
  TableReader reader(member.value, source_, "LFO '" + member.key + "'");
  LfoUse use;
  use.name = member.key;
  reader.string("curve");  // required
  use.curve = curve_name(reader, "curve", Role::function);
  exclude(reader, "rate_hz", "beats");
  use.spec.rate_hz = reader.number("rate_hz", use.spec.rate_hz, 1e-4, 1000);
  use.spec.beats = reader.number("beats", 0, 1e-3, kMostBeats);
  constexpr dsp::LfoSpec::Mode kModes[] = {dsp::LfoSpec::Mode::key, dsp::LfoSpec::Mode::free,
                                           dsp::LfoSpec::Mode::one_shot};
  use.spec.mode = kModes[reader.choice("mode", 0, {"key", "free", "one_shot"})];
  use.spec.phase_cycles = reader.number("phase", 0, 0, 1);
  use.spec.delay_s = reader.number("delay_s", 0, 0, 60);
  use.spec.fade_s = reader.number("fade_s", 0, 0, 60);
  use.spec.random = reader.boolean("random", false);
  keep(reader.finish());
  patch_.lfos.push_back(std::move(use));
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
