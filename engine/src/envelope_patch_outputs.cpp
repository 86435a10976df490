// SPDX-License-Identifier: MIT
// Where an envelope patch sends its values, and what it tells when an envelope passes a place.
#include <algorithm>
#include <optional>

#include "knotwave/base/suggest.h"
#include "knotwave/engine/midi_value.h"

#include "envelope_patch_limits.h"
#include "envelope_patch_reader.h"
#include "patch_words.h"

namespace knotwave::engine {
namespace {

constexpr double kMostOf = 1e6;

struct Destination {
  OutputKind kind = OutputKind::control;
  int number = 0;
};

std::optional<Destination> find_destination(std::string_view word) {
  if (word == "osc") return Destination{OutputKind::osc};
  if (word == "cv") return Destination{OutputKind::voltage, 1};
  if (const auto value = find_midi_value(word)) return Destination{value->kind, value->number};
  return std::nullopt;
}

constexpr std::string_view kDestinationWords[] = {
    "bend", "pressure", "poly_pressure", "osc", "cv", "cc1", "cc7", "cc11", "cc74", "nrpn100"};
constexpr const char* kDestinations =
    "; there are cc0 to cc119, nrpn0 to nrpn16383, bend, pressure, poly_pressure, osc and cv";
constexpr base::Synonym kDestinationSynonyms[] = {
    {"modwheel", "cc1"},
    {"modulation", "cc1"},
    {"volume", "cc7"},
    {"expression", "cc11"},
    {"cutoff", "cc74"},
    {"pitchbend", "bend"},
    {"pitch", "bend"},
    {"aftertouch", "pressure"},
    {"channelpressure", "pressure"},
    {"polyaftertouch", "poly_pressure"},
    {"voltage", "cv"},
    {"volts", "cv"},
};

// What of a patch can be sent.
std::vector<std::string> sendable(const PatchSpec& patch) {
  std::vector<std::string> words;
  for (const EnvelopeUse& envelope : patch.envelopes) words.push_back(envelope.name);
  for (const LfoUse& lfo : patch.lfos) words.push_back(lfo.name);
  for (const std::string& name : patch.free_numbers) {
    words.push_back(std::string(kFreePrefix) + name);
  }
  return words;
}

}  // namespace

void EnvelopePatchReader::read_outputs() {
  int number = 0;
  for (const Node* table : tables_of("outputs", "an output", kMaxOutputs)) {
    if (ok()) read_output(*table, ++number);
  }
}

void EnvelopePatchReader::read_output(const Node& table, int number) {
  TableReader reader(table, source_, "output " + std::to_string(number));
  OutputSpec output;
  read_source(reader, output);
  read_destination(reader, output);
  const bool is_midi = output.kind != OutputKind::osc && output.kind != OutputKind::voltage;
  output.port = port_name(reader, "port");
  read_output_channel(reader, output);
  refuse(reader, {"port", "channel"}, is_midi, "outputs to MIDI");
  read_address(reader, output);
  const int audio_channel = reader.integer("cv_channel", 1, 1, kMaxVoltageChannels);
  if (output.kind == OutputKind::voltage) output.number = audio_channel;
  refuse(reader, {"cv_channel"}, output.kind == OutputKind::voltage, "to = \"cv\"");
  read_law(reader, output);
  keep(reader.finish());
  spec_.outputs.push_back(std::move(output));
}

void EnvelopePatchReader::read_source(TableReader& reader, OutputSpec& output) {
  const std::string word = reader.string("from");
  if (!reader.ok()) return;
  const auto source = find_source(patch_, word);
  if (source && (source->source == MapSource::envelope || source->source == MapSource::lfo ||
                 source->source == MapSource::free_number)) {
    output.source = source->source;
    output.source_index = source->index;
    return;
  }
  const std::vector<std::string> words = sendable(patch_);
  std::string hint =
      base::suggestion(word, std::vector<std::string_view>(words.begin(), words.end()));
  if (source) hint = ": a map brings '" + word + "' to a free number, which can be sent";
  reader.fail_at(*reader.node("from"), ErrorCode::unknown_name,
                 "there is no envelope, LFO or free number '" + word + "'" + hint);
}

void EnvelopePatchReader::read_destination(TableReader& reader, OutputSpec& output) {
  const std::string word = reader.string("to");
  const Node* at = reader.node("to");
  if (!reader.ok()) return;
  const auto found = find_destination(word);
  if (!found) {
    const bool is_range = number_after("cc", word) >= 0 || number_after("nrpn", word) >= 0;
    std::string hint = "; there are cc0 to cc119 and nrpn0 to nrpn16383";
    if (!is_range) hint = base::suggestion(word, kDestinationWords, kDestinationSynonyms);
    if (hint.empty()) hint = kDestinations;
    return reader.fail_at(*at, is_range ? ErrorCode::value_out_of_range : ErrorCode::unknown_name,
                          "there is no output '" + word + "'" + hint);
  }
  output.kind = found->kind;
  output.number = found->number;
  const Node* bits = reader.node("bits");
  output.bits = reader.integer("bits", 7, 7, 14);
  if (bits != nullptr && reader.ok() && output.bits != 7 && output.bits != 14) {
    reader.fail_at(*bits, ErrorCode::value_out_of_range, "bits must be 7 or 14");
  }
  refuse(reader, {"bits"}, found->kind == OutputKind::control || found->kind == OutputKind::nrpn,
         "controllers and NRPN");
  if (found->kind == OutputKind::pitch_bend) output.bits = 14;
  if (found->kind == OutputKind::control && output.bits == 14 && output.number > kLastFineControl) {
    reader.fail_at(*bits, ErrorCode::value_out_of_range,
                   word + " has no low half: 14 bits are for cc0 to cc31");
  }
}

void EnvelopePatchReader::read_output_channel(TableReader& reader, OutputSpec& output) {
  const Node* at = reader.node("channel");
  const bool is_of_note = at != nullptr && at->kind == Node::Kind::string;
  if (is_of_note) {
    reader.choice("channel", 0, {"note"});
    output.channel = 0;
  } else {
    output.channel = reader.integer("channel", 1, 1, 16);
  }
  using Kind = TriggerSpec::Kind;
  const Kind kind = spec_.trigger.kind;
  if (is_of_note && kind != Kind::note && kind != Kind::gate) {
    reader.fail_at(*at, ErrorCode::malformed,
                   "a trigger from a clock or loop has no channel of its own: channel = 1 to 16");
  }
  if (output.kind == OutputKind::poly_pressure && kind != Kind::note && reader.ok()) {
    reader.fail_at(*reader.node("to"), ErrorCode::malformed,
                   "\"poly_pressure\" is of a key: it needs a trigger from = \"note\"");
  }
}

void EnvelopePatchReader::read_address(TableReader& reader, OutputSpec& output) {
  const bool is_osc = output.kind == OutputKind::osc;
  output.address = is_osc ? reader.string("address") : reader.string("address", "");
  output.osc_hz = reader.number("rate_hz", output.osc_hz, 1, kMostOscHz);
  refuse(reader, {"address", "rate_hz"}, is_osc, "to = \"osc\"");
  if (is_osc && reader.ok() && !is_osc_address(output.address)) {
    reader.fail_at(*reader.node("address"), ErrorCode::malformed,
                   "'" + output.address +
                       "' is no OSC address: it begins with '/' and has no blanks and none of "
                       "#*,?[]{}");
  }
}

void EnvelopePatchReader::read_law(TableReader& reader, OutputSpec& output) {
  const auto pair = [&](const char* key, double& first, double& second, double low, double high) {
    const Node* at = reader.array(key);
    const std::vector<double> ends = reader.numbers(key);
    if (at == nullptr || !reader.ok()) return;
    if (ends.size() != 2) {
      return reader.fail_at(*at, ErrorCode::dimension_mismatch,
                            std::string(key) + " must be two numbers: [from, to]");
    }
    for (std::size_t i = 0; i < 2; ++i) {
      if (ends[i] >= low && ends[i] <= high) continue;
      return reader.fail_at(at->items[i], ErrorCode::value_out_of_range,
                            std::string(key) + ": " + base::number_text(ends[i]) + " is outside " +
                                base::number_text(low) + " to " + base::number_text(high));
    }
    first = ends[0];
    second = ends[1];
  };
  pair("of", output.of_low, output.of_high, -kMostOf, kMostOf);
  if (reader.ok() && !(output.of_low < output.of_high)) {
    reader.fail_at(*reader.node("of"), ErrorCode::value_out_of_range,
                   "of must be two rising numbers; a falling 'range' turns an output round");
  }
  const OutputLimits limits = limits_of(output);
  output.low = limits.usual_low;
  output.high = limits.usual_high;
  pair("range", output.low, output.high, limits.low, limits.high);
  const auto [least, most] = std::minmax(output.low, output.high);
  output.rest = reader.number("rest", std::clamp(0.0, least, most), limits.low, limits.high);
  output.curve = curve_name(reader, "curve", Role::function);
}

void EnvelopePatchReader::read_events() {
  int number = 0;
  for (const Node* table : tables_of("events", "an event", kMaxPlaceEvents)) {
    if (ok()) read_event(*table, ++number);
  }
}

void EnvelopePatchReader::read_event(const Node& table, int number) {
  TableReader reader(table, source_, "event " + std::to_string(number));
  PlaceEventSpec event;
  read_place(reader, event);
  exclude(reader, "note", "gate");
  const bool is_note = reader.node("note") != nullptr;
  if (!is_note && reader.node("gate") == nullptr) {
    reader.fail_at(table, ErrorCode::missing_key, "'note' (or 'gate') is missing");
  }
  event.kind = is_note ? PlaceEventSpec::Kind::note : PlaceEventSpec::Kind::voltage;
  event.key = reader.integer("note", event.key, 0, 127);
  event.channel = reader.integer("channel", event.channel, 1, 16);
  event.velocity = reader.integer("velocity", event.velocity, 1, 127);
  event.port = port_name(reader, "port");
  refuse(reader, {"channel", "velocity", "port"}, is_note, "events with a 'note'");
  event.voltage_channel = reader.integer("gate", 1, 1, kMaxVoltageChannels);
  event.volts = reader.number("volts", event.volts, -kMostVolts, kMostVolts);
  refuse(reader, {"volts"}, !is_note, "events with a 'gate'");
  event.length_s = reader.number("seconds", event.length_s, kLeastEventSeconds, kMostEventSeconds);
  keep(reader.finish());
  spec_.place_events.push_back(std::move(event));
}

void EnvelopePatchReader::read_place(TableReader& reader, PlaceEventSpec& event) {
  const std::string name = reader.string("envelope");
  if (!reader.ok()) return;
  const auto& envelopes = patch_.envelopes;
  const auto found = std::find_if(envelopes.begin(), envelopes.end(),
                                  [&](const EnvelopeUse& use) { return use.name == name; });
  if (found == envelopes.end()) {
    return reader.fail_at(
        *reader.node("envelope"), ErrorCode::unknown_name,
        "there is no envelope '" + name + "'" + base::suggestion(name, names_of(envelopes)));
  }
  event.envelope = static_cast<int>(found - envelopes.begin());
  const Node* at = reader.node("at");
  using At = PlaceEventSpec::At;
  if (at != nullptr && at->is_number()) {
    event.at = At::place;
    const auto [low, high] = places_of(found->curve);
    event.place_u = reader.number("at", low, low, high);
    return;
  }
  event.at = reader.choice("at", 0, {"end", "loop"}) == 0 ? At::end : At::loop;
  const bool has_loop = found->spec.loop_end_u > found->spec.loop_start_u;
  if (event.at == At::loop && !has_loop && reader.ok()) {
    reader.fail_at(*at, ErrorCode::malformed, "envelope '" + name + "' has no loop");
  }
}

}  // namespace knotwave::engine
