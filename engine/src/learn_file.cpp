// SPDX-License-Identifier: MIT
// Learnt knobs from text and to text.
#include <algorithm>

#include "knotwave/base/document.h"
#include "knotwave/base/file.h"
#include "knotwave/curves/curve_file.h"

#include "learn_check.h"

namespace knotwave::engine {
namespace {

using base::Node;
using base::TableReader;

std::string knob_name(std::size_t index) { return "knob " + std::to_string(index + 1); }

std::string on_channel(int controller, int channel) {
  return "controller " + std::to_string(controller) +
         (channel == 0 ? " of any channel" : " of channel " + std::to_string(channel));
}

std::optional<LearnFault> range_fault(const LearnedKnob& knob, std::size_t index) {
  const auto fault = [&](const char* key, const std::string& what) {
    return LearnFault{index, key,
                      fail(ErrorCode::value_out_of_range, std::string(key) + " is " + what)};
  };
  for (const auto& [key, number] : {std::pair{"from", knob.from}, {"to", knob.to}}) {
    if (is_learnable(number)) continue;
    return fault(key, std::to_string(number) +
                          "; a knob can be controller 1 to 119, but not 6, 32, 38 or 96 to 101");
  }
  for (const auto& [key, number] :
       {std::pair{"from_channel", knob.from_channel}, {"to_channel", knob.to_channel}}) {
    if (number >= 0 && number <= 16) continue;
    return fault(key, std::to_string(number) + "; channels are 1 to 16");
  }
  return {};
}

/// A knob before `index` that has the same source or target.
std::optional<LearnFault> twin_fault(const std::vector<LearnedKnob>& knobs, std::size_t index) {
  const LearnedKnob& knob = knobs[index];
  for (std::size_t i = 0; i < index; ++i) {
    const LearnedKnob& other = knobs[i];
    const bool same_from = other.from == knob.from && other.from_channel == knob.from_channel;
    const bool same_to = other.to == knob.to && other.to_channel == knob.to_channel;
    if (!same_from && !same_to) continue;
    const std::string what = same_from ? on_channel(knob.from, knob.from_channel) + " is "
                                       : on_channel(knob.to, knob.to_channel) + " is moved by ";
    return LearnFault{index, same_from ? "from" : "to",
                      fail(ErrorCode::duplicate_name, what + knob_name(i) + " already")};
  }
  return {};
}

LearnedKnob read_knob(TableReader& reader) {
  LearnedKnob knob;
  for (const char* key : {"from", "to"}) {
    if (reader.required(key) == nullptr) return knob;
  }
  knob.from = reader.integer("from", 0, 0, 127);
  knob.from_channel = reader.integer("from_channel", 0, 1, 16);
  knob.to = reader.integer("to", 0, 0, 127);
  knob.to_channel = reader.integer("to_channel", 0, 1, 16);
  knob.is_soft = reader.choice("takeover", 0, {"soft", "jump"}) == 0;
  return knob;
}

/// TOML's basic string.
std::string quoted(std::string_view text) {
  constexpr char kHex[] = "0123456789ABCDEF";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte == 0x7F) {
      out += "\\u00";
      out += kHex[byte >> 4];
      out += kHex[byte & 15];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

Error placed(Error error, std::string_view source, const Node& at) {
  error.source = source;
  error.line = at.line;
  error.column = at.column;
  return error;
}

/// The tables of [[knobs]], none if there are none.
const std::vector<Node>& knob_tables(TableReader& top) {
  static const std::vector<Node> none;
  const Node* knobs = top.array("knobs");
  return knobs == nullptr ? none : knobs->items;
}

}  // namespace

std::optional<LearnFault> learn_fault(const LearnSpec& spec) {
  if (spec.knobs.size() > kMaxLearnedKnobs) {
    return LearnFault{kMaxLearnedKnobs, "",
                      fail(ErrorCode::value_out_of_range,
                           "there are " + std::to_string(spec.knobs.size()) + " knobs; " +
                               std::to_string(kMaxLearnedKnobs) + " are the most")};
  }
  for (std::size_t i = 0; i < spec.knobs.size(); ++i) {
    if (auto fault = range_fault(spec.knobs[i], i)) return fault;
    if (auto fault = twin_fault(spec.knobs, i)) return fault;
  }
  return {};
}

Result<LearnSpec> parse_midi_learn(std::string_view text, std::string_view source_name) {
  const auto root = base::parse_document(text, source_name);
  if (!root) return root.error();
  const auto kind = curves::read_file_kind(*root, source_name);
  if (!kind) return kind.error();
  const Node& said = *root->find("kind");
  if (*kind != curves::FileKind::midi_learn) {
    return placed(fail(ErrorCode::unsupported, "this file's kind is '" + said.text +
                                                   "'; learnt knobs (kind = "
                                                   "\"midi-learn\") are needed here"),
                  source_name, said);
  }
  TableReader top(*root, source_name, "MIDI learn file");
  for (const char* key : {"format", "kind"}) top.node(key);
  LearnSpec spec;
  spec.about = top.string("about", "");
  const std::vector<Node>& tables = knob_tables(top);
  if (const auto fine = top.finish(); !fine) return fine.error();
  for (const Node& table : tables) {
    if (table.kind != Node::Kind::table) {
      return placed(fail(ErrorCode::wrong_type, "knobs are tables; begin each with [[knobs]]"),
                    source_name, table);
    }
    TableReader reader(table, source_name, knob_name(spec.knobs.size()));
    spec.knobs.push_back(read_knob(reader));
    if (const auto fine = reader.finish(); !fine) return fine.error();
  }
  if (const auto fault = learn_fault(spec)) {
    const Node& table = tables[std::min(fault->knob, tables.size() - 1)];
    const Node* at = table.find(fault->key);
    return placed(fault->error, source_name, at == nullptr ? table : *at);
  }
  return spec;
}

Result<LearnSpec> read_midi_learn(const std::string& path) {
  const auto text = base::read_file(path, base::kMaxDocumentBytes);
  if (!text) return text.error();
  return parse_midi_learn(*text, path);
}

std::string write_midi_learn(const LearnSpec& spec) {
  std::string out = "format = 1\nkind = \"midi-learn\"\n";
  if (!spec.about.empty()) out += "about = " + quoted(spec.about) + "\n";
  const auto line = [&out](const char* key, int number) {
    out += std::string(key) + " = " + std::to_string(number) + "\n";
  };
  for (const LearnedKnob& knob : spec.knobs) {
    out += "\n[[knobs]]\n";
    line("from", knob.from);
    if (knob.from_channel != 0) line("from_channel", knob.from_channel);
    line("to", knob.to);
    if (knob.to_channel != 0) line("to_channel", knob.to_channel);
    if (!knob.is_soft) out += "takeover = \"jump\"\n";
  }
  return out;
}

}  // namespace knotwave::engine
