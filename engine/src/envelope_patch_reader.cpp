// SPDX-License-Identifier: MIT
// An envelope patch: its own keys, what triggers it, its ports. Outputs and events are in
// envelope_patch_outputs.cpp.
#include "envelope_patch_reader.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "knotwave/base/suggest.h"

#include "patch_words.h"
#include "text_line.h"

namespace knotwave::engine {
namespace {

constexpr int kLastController = 119;  // above are channel mode messages

// What says how a patch sounds.
constexpr std::string_view kSoundKeys[] = {
    "oscillators", "noise",       "crossfade",      "shaper",      "filter", "gain_db", "pan",
    "glide_s",     "glide_curve", "bend_semitones", "velocity_db", "tuning", "keymap"};

constexpr base::Synonym kTriggerSynonyms[] = {
    {"notes", "note"}, {"key", "note"},    {"keys", "note"}, {"sustain", "pedal"},
    {"gate", "ccN"},   {"tempo", "clock"}, {"free", "loop"}, {"always", "loop"},
};

}  // namespace

Result<EnvelopePatchSpec> EnvelopePatchReader::read() {
  using Section = void (EnvelopePatchReader::*)();
  // Top first, so that a misspelt section is named before what misses it.
  constexpr Section kSections[] = {
      &EnvelopePatchReader::refuse_sound,   &EnvelopePatchReader::read_top,
      &EnvelopePatchReader::read_envelopes, &EnvelopePatchReader::read_lfos,
      &EnvelopePatchReader::read_maps,      &EnvelopePatchReader::read_trigger,
      &EnvelopePatchReader::read_outputs,   &EnvelopePatchReader::read_events,
      &EnvelopePatchReader::require_work};
  for (const Section section : kSections) {
    if (ok()) (this->*section)();
  }
  if (error_) return *error_;
  spec_.patch = std::move(patch_);
  return std::move(spec_);
}

void EnvelopePatchReader::refuse_sound() {
  for (const Node::Member& member : root_.members) {
    if (std::find(std::begin(kSoundKeys), std::end(kSoundKeys), member.key) == std::end(kSoundKeys))
      continue;
    return fail_at(member.line, member.column, ErrorCode::unsupported,
                   "an envelope patch makes no sound: '" + member.key +
                       "' belongs to a patch (kind = \"patch\")");
  }
}

void EnvelopePatchReader::read_top() {
  TableReader top(root_, source_, "envelope patch");
  for (const char* section : {"trigger", "ports", "outputs", "events", "notes_port"}) {
    top.node(section);
  }
  read_common(top);
  patch_.polyphony = top.integer("polyphony", patch_.polyphony, 1, kMaxEnvelopeVoices);
  constexpr NoteOutput kNotes[] = {NoteOutput::off, NoteOutput::thru, NoteOutput::mpe};
  spec_.notes = kNotes[top.choice("notes", 0, {"off", "thru", "mpe"})];
  if (const Node* at = top.node("notes"); at != nullptr && top.ok() &&
                                          spec_.notes == NoteOutput::mpe &&
                                          patch_.mode != PlayMode::poly) {
    top.fail_at(*at, ErrorCode::malformed, "notes = \"mpe\" needs mode = \"poly\"");
  }
  keep(top.finish());
  if (ok()) read_curves();
  if (ok()) read_ports();
  if (!ok()) return;
  TableReader again(root_, source_, "envelope patch");
  spec_.notes_port = port_name(again, "notes_port");
  refuse(again, {"notes_port"}, spec_.notes != NoteOutput::off, "notes = \"thru\" or \"mpe\"");
  if (!again.ok()) keep(again.finish());
}

void EnvelopePatchReader::read_ports() {
  for (const Node::Member* member : named_tables("ports", kMaxOutputPorts)) {
    TableReader reader(member->value, source_, "port '" + member->key + "'");
    PortSpec port;
    port.name = member->key;
    port.device = read_text_line(reader, "device");
    constexpr PortSpec::Wire kWires[] = {PortSpec::Wire::none, PortSpec::Wire::usb,
                                         PortSpec::Wire::din};
    port.wire = kWires[reader.choice("wire", 1, {"none", "usb", "din"})];
    port.running_status = reader.boolean("running_status", true);
    refuse(reader, {"running_status"}, port.wire == PortSpec::Wire::din, "wire = \"din\"");
    keep(reader.finish());
    if (!ok()) return;
    spec_.ports.push_back(std::move(port));
  }
}

std::string EnvelopePatchReader::port_name(TableReader& reader, const char* key) {
  const Node* at = reader.node(key);
  std::string name = reader.string(key, "");
  if (at == nullptr || !reader.ok() || has_name(spec_.ports, name)) return name;
  reader.fail_at(
      *at, ErrorCode::unknown_name,
      "there is no [ports." + name + "]" + base::suggestion(name, names_of(spec_.ports)));
  return "";
}

void EnvelopePatchReader::refuse(TableReader& reader, std::initializer_list<const char*> keys,
                                 bool belongs, const char* to_what) {
  for (const char* key : keys) {
    const Node* at = reader.node(key);
    if (at == nullptr || belongs) continue;
    reader.fail_at(*at, ErrorCode::malformed, std::string("'") + key + "' belongs to " + to_what);
  }
}

void EnvelopePatchReader::read_trigger() {
  TableReader top(root_, source_, "envelope patch");
  const Node* table = top.table("trigger");
  if (!top.ok()) return keep(top.finish());
  TriggerSpec& trigger = spec_.trigger;
  if (table != nullptr) {
    TableReader reader(*table, source_, "trigger");
    read_trigger_source(reader);
    using Kind = TriggerSpec::Kind;
    const bool is_clock = trigger.kind == Kind::clock;
    read_keys(reader);
    refuse(reader, {"keys"}, trigger.kind == Kind::note, "from = \"note\"");
    trigger.threshold = reader.integer("threshold", trigger.threshold, 1, 127);
    refuse(reader, {"threshold"}, trigger.kind == Kind::gate, "from = \"pedal\" or \"ccN\"");
    trigger.beats = reader.number("beats", trigger.beats, 1.0 / 96, 1024);
    trigger.offset_beats = reader.number("offset_beats", 0, 0, trigger.beats);
    trigger.gate_share = reader.number("gate", trigger.gate_share, 0, 1);
    refuse(reader, {"beats", "offset_beats", "gate"}, is_clock, "from = \"clock\"");
    trigger.program = reader.integer("program", -1, 0, 127);
    read_trigger_channel(reader);
    keep(reader.finish());
  }
  const bool has_notes = trigger.kind == TriggerSpec::Kind::note;
  if (ok() && spec_.notes == NoteOutput::mpe && !has_notes) {
    const Node* at = root_.find("notes");
    fail_at(at->line, at->column, ErrorCode::malformed,
            "notes = \"mpe\" needs a trigger from = \"note\"");
  }
}

void EnvelopePatchReader::read_trigger_source(TableReader& reader) {
  const Node* at = reader.node("from");
  const std::string word = reader.string("from", "note");
  using Kind = TriggerSpec::Kind;
  TriggerSpec& trigger = spec_.trigger;
  if (word == "note") {
    trigger.kind = Kind::note;
  } else if (word == "clock") {
    trigger.kind = Kind::clock;
  } else if (word == "loop") {
    trigger.kind = Kind::loop;
  } else if (word == "pedal" || is_controller_word(word)) {
    trigger.kind = Kind::gate;
    if (word == "pedal") return;
    const int number = number_after("cc", word);
    if (number >= 0 && number <= kLastController) {
      trigger.control = number;
    } else {
      reader.fail_at(*at, ErrorCode::value_out_of_range, "controllers are cc0 to cc119");
    }
  } else if (reader.ok()) {
    constexpr std::string_view kWords[] = {"note", "pedal", "ccN", "clock", "loop"};
    reader.fail_at(*at, ErrorCode::unknown_name,
                   "from is '" + word +
                       "'; it must be one of note, pedal, cc0 to cc119, clock, "
                       "loop" +
                       base::suggestion(word, kWords, kTriggerSynonyms));
  }
}

void EnvelopePatchReader::read_trigger_channel(TableReader& reader) {
  const Node* at = reader.node("channel");
  TriggerSpec& trigger = spec_.trigger;
  const bool hears_channels =
      trigger.kind == TriggerSpec::Kind::note || trigger.kind == TriggerSpec::Kind::gate;
  if (at != nullptr && at->kind == Node::Kind::string) {
    reader.choice("channel", 0, {"any"});
  } else {
    trigger.channel = reader.integer("channel", 0, 1, 16);
  }
  refuse(reader, {"channel"}, hears_channels || trigger.program >= 0,
         "a trigger from notes or controllers, or with a 'program'");
  if (reader.ok() && !hears_channels && trigger.program >= 0 && trigger.channel == 0) {
    reader.fail_at(*reader.node("program"), ErrorCode::missing_key,
                   "'program' needs a 'channel' (1 to 16) here");
  }
}

// A key, or [lowest, highest].
void EnvelopePatchReader::read_keys(TableReader& reader) {
  const Node* at = reader.node("keys");
  if (at == nullptr) return;
  TriggerSpec& trigger = spec_.trigger;
  if (at->kind != Node::Kind::array) {
    trigger.key_low = trigger.key_high = reader.integer("keys", 0, 0, 127);
    return;
  }
  const std::vector<double> ends = reader.numbers("keys");
  const bool whole = std::all_of(at->items.begin(), at->items.end(), [](const Node& item) {
    return item.kind == Node::Kind::integer && item.integer >= 0 && item.integer <= 127;
  });
  if (!whole || ends.size() != 2 || ends[0] > ends[1]) {
    return reader.fail_at(*at, ErrorCode::value_out_of_range,
                          "keys must be a number from 0 to 127, or two rising ones: [36, 96]");
  }
  trigger.key_low = static_cast<int>(ends[0]);
  trigger.key_high = static_cast<int>(ends[1]);
}

void EnvelopePatchReader::require_work() {
  if (!spec_.outputs.empty() || !spec_.place_events.empty()) return;
  fail_at(root_.line, root_.column, ErrorCode::malformed,
          "the patch has no [[outputs]] and no [[events]], so nothing would come out");
}

}  // namespace knotwave::engine
