// SPDX-License-Identifier: MIT
// Knotwave Envelope as text: the patch with every file it names, and the parameters that were
// moved.
#include <algorithm>
#include <optional>
#include <utility>

#include "knotwave/base/document.h"
#include "knotwave/base/suggest.h"
#include "knotwave/plugins/factory.h"
#include "knotwave/plugins/plugin_list.h"

#include "envelope_plugin.h"

namespace knotwave::plugins {
namespace {

using base::Node;
using base::TableReader;
using engine::EnvelopePatchSpec;
using engine::FileText;

constexpr const char* kSource = "the plugin's state";
constexpr const char* kPatchAlone = "patch.toml";
constexpr std::size_t kMostFiles = 64;

/// A plugin sends nothing over the network, and has so many voltages.
Result<void> check(const EnvelopePatchSpec& spec) {
  const auto refuse = [&spec](std::string what) {
    Error error = fail(ErrorCode::unsupported, std::move(what));
    error.source = spec.patch.source_name;
    return error;
  };
  const auto beyond = [](int channel) {
    return "audio channel " + std::to_string(channel) + "; the plugin has " +
           std::to_string(EnvelopePlugin::kVoltages) + " control voltages";
  };
  for (std::size_t i = 0; i < spec.outputs.size(); ++i) {
    const engine::OutputSpec& output = spec.outputs[i];
    const std::string name = "output " + std::to_string(i + 1) + " of '" + spec.patch.name + "'";
    if (output.kind == engine::OutputKind::osc) {
      return refuse(name + " goes to the OSC address " + output.address +
                    ": a plugin sends nothing over the network; knotwave-env does");
    }
    if (output.kind == engine::OutputKind::voltage &&
        output.number > static_cast<int>(EnvelopePlugin::kVoltages)) {
      return refuse(name + " goes to " + beyond(output.number));
    }
  }
  for (std::size_t i = 0; i < spec.place_events.size(); ++i) {
    const engine::PlaceEventSpec& event = spec.place_events[i];
    if (event.kind != engine::PlaceEventSpec::Kind::voltage ||
        event.voltage_channel <= static_cast<int>(EnvelopePlugin::kVoltages)) {
      continue;
    }
    return refuse("event " + std::to_string(i + 1) + " of '" + spec.patch.name + "' goes to " +
                  beyond(event.voltage_channel));
  }
  return {};
}

Result<EnvelopePatchSpec> read_patch(const std::string& path, std::span<const FileText> files) {
  auto spec = engine::read_envelope_patch(path, files);
  if (!spec) return spec;
  if (auto fine = check(*spec); !fine) return fine.error();
  return spec;
}

// To text.

/// A basic string of TOML over several lines.
void append_quoted(std::string& text, std::string_view bytes) {
  text += "\"\"\"\n";
  for (const char letter : bytes) {
    const auto byte = static_cast<unsigned char>(letter);
    if (letter == '\\' || letter == '"') {
      text += '\\';
      text += letter;
    } else if (letter == '\n' || letter == '\t' || (byte >= 0x20 && byte != 0x7F)) {
      text += letter;
    } else {
      constexpr char kDigits[] = "0123456789ABCDEF";
      text += "\\u00";
      text += kDigits[byte >> 4];
      text += kDigits[byte & 15];
    }
  }
  text += "\"\"\"\n";
}

std::string value_text(const Parameter& parameter, double value) {
  if (parameter.choices.empty()) return base::number_text(value);
  return '"' + parameter.choices[static_cast<std::size_t>(value)] + '"';
}

// From text.

std::optional<double> read_value(TableReader& reader, const Parameter& parameter) {
  const Node* const node = reader.node(parameter.symbol);
  if (node == nullptr) return std::nullopt;
  if (parameter.choices.empty()) {
    return reader.number(parameter.symbol, parameter.initial, parameter.low, parameter.high);
  }
  const std::string word = reader.string(parameter.symbol);
  const auto& choices = parameter.choices;
  const auto found = std::find(choices.begin(), choices.end(), word);
  if (found != choices.end()) return static_cast<double>(found - choices.begin());
  const std::vector<std::string_view> known(choices.begin(), choices.end());
  reader.fail_at(
      *node, ErrorCode::unknown_name,
      "'" + word + "' is no choice of '" + parameter.symbol + "'" + base::suggestion(word, known));
  return std::nullopt;
}

struct State {
  EnvelopePatchSpec spec;
  std::vector<double> values;
};

Result<std::vector<FileText>> read_files(TableReader& reader, const Node& array) {
  std::vector<FileText> files;
  for (const Node& item : array.items) {
    if (item.kind != Node::Kind::table || files.size() == kMostFiles) {
      reader.fail_at(
          item, ErrorCode::malformed,
          "files are at most " + std::to_string(kMostFiles) + " tables; begin each with [[files]]");
      break;
    }
    TableReader file(item, kSource, "file " + std::to_string(files.size() + 1));
    std::string path = file.string("path");
    std::string text = file.string("text");
    files.push_back({std::move(path), std::move(text)});
    if (auto fine = file.finish(); !fine) return fine.error();
  }
  if (auto fine = reader.finish(); !fine) return fine.error();
  return files;
}

Result<State> read_state(const Node& root, const ParameterTable& table) {
  TableReader reader(root, kSource, "state");
  reader.integer("format", 1, 1, 1);
  for (const char* key : {"kind", "plugin"}) {
    const bool is_kind = std::string_view(key) == "kind";
    const std::string_view wanted = is_kind ? "plugin" : "envelope";
    const std::string found = reader.string(key);
    if (!reader.ok() || found == wanted) continue;
    reader.fail_at(*root.find(key), ErrorCode::unsupported,
                   std::string(key) + " is '" + found + "'; a state of Knotwave Envelope (" + key +
                       " = \"" + std::string(wanted) + "\") or a patch is needed here");
  }
  const std::string patch = reader.string("patch");
  const Node* const parameters = reader.table("parameters");
  const Node* const files = reader.array("files");
  State state;
  for (const Parameter& parameter : table.all()) state.values.push_back(parameter.initial);
  if (reader.ok() && parameters != nullptr) {
    TableReader values(*parameters, kSource, "[parameters]");
    for (std::size_t place = 0; place < table.size(); ++place) {
      if (const auto value = read_value(values, table[place])) state.values[place] = *value;
    }
    if (auto fine = values.finish(); !fine) return fine.error();
  }
  static const Node kNone;
  auto texts = read_files(reader, files == nullptr ? kNone : *files);
  if (!texts) return texts.error();
  auto spec = read_patch(patch, *texts);
  if (!spec) return spec.error();
  state.spec = *std::move(spec);
  return state;
}

}  // namespace

std::string EnvelopePlugin::state() const {
  std::string text = "format = 1\nkind = \"plugin\"\nplugin = \"envelope\"\npatch = ";
  append_quoted(text, spec_.patch.source_name);
  std::string moved;
  for (std::size_t place = 0; place < table().size(); ++place) {
    const Parameter& description = table()[place];
    if (parameter(place) == description.initial) continue;
    moved += description.symbol + " = " + value_text(description, parameter(place)) + "\n";
  }
  if (!moved.empty()) text += "\n[parameters]\n" + moved;
  for (const FileText& file : spec_.texts) {
    text += "\n[[files]]\npath = ";
    append_quoted(text, file.path);
    text += "text = ";
    append_quoted(text, file.bytes);
  }
  return text;
}

Result<void> EnvelopePlugin::load_state(std::string_view text) {
  const auto root = base::parse_document(text, kSource);
  if (!root) return root.error();
  const Node* const kind = root->find("kind");
  if (kind != nullptr && kind->text == "envelope") {
    const FileText alone{kPatchAlone, std::string(text)};
    auto spec = read_patch(kPatchAlone, {&alone, 1});
    if (!spec) return spec.error();
    return load(*std::move(spec));
  }
  auto state = read_state(*root, table());
  if (!state) return state.error();
  if (auto loaded = load(std::move(state->spec)); !loaded) return loaded.error();
  for (std::size_t place = 0; place < state->values.size(); ++place) {
    set_parameter(place, state->values[place]);
  }
  return {};
}

Result<void> EnvelopePlugin::load_preset(std::size_t number) {
  const auto names = envelope_info().presets;
  if (number >= names.size()) {
    return fail(ErrorCode::value_out_of_range, "there is no preset " + std::to_string(number) +
                                                   "; 0 to " + std::to_string(names.size() - 1) +
                                                   " are there");
  }
  auto spec = read_patch("envelopes/" + names[number] + ".toml", factory_files());
  if (!spec) return spec.error();
  return load(*std::move(spec));
}

}  // namespace knotwave::plugins
