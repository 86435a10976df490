// SPDX-License-Identifier: MIT
#include "bank_reader.h"

#include <algorithm>

#include "text_line.h"

namespace knotwave::engine {
namespace {

constexpr int kMaxEntries = 4096;

struct Range {
  int low = 0;
  int high = 127;
};

// A number, or [low, high].
Range read_range(base::TableReader& reader, const char* key, Range fallback) {
  const base::Node* at = reader.node(key);
  if (at == nullptr) return fallback;
  if (at->kind != base::Node::Kind::array) {
    const int one = reader.integer(key, 0, 0, 127);
    return {one, one};
  }
  const std::vector<double> ends = reader.numbers(key);
  const bool whole = std::all_of(at->items.begin(), at->items.end(), [](const base::Node& item) {
    return item.kind == base::Node::Kind::integer && item.integer >= 0 && item.integer <= 127;
  });
  if (!whole || ends.size() != 2 || ends[0] > ends[1]) {
    reader.fail_at(
        *at, ErrorCode::value_out_of_range,
        std::string(key) + " must be a number from 0 to 127, or two rising ones: [0, 7]");
    return fallback;
  }
  return {static_cast<int>(ends[0]), static_cast<int>(ends[1])};
}

bool overlap(const BankEntry& a, const BankEntry& b) {
  if (a.key >= 0 || b.key >= 0) return a.key == b.key;
  return a.bank_msb == b.bank_msb && a.bank_lsb == b.bank_lsb && a.program_low <= b.program_high &&
         b.program_low <= a.program_high;
}

}  // namespace

Result<BankSpec> BankReader::read() {
  TableReader top(root_, source_, "bank");
  for (const char* key : {"format", "kind", "about"}) top.node(key);
  bank_.name = read_text_line(top, "name");
  top.string("about", "");
  bank_.gain_db = top.number("gain_db", 0, -96, 24);
  const Node* programs = top.array("programs");
  const Node* drums = top.table("drums");
  keep(top.finish());
  if (!error_ && programs == nullptr && drums == nullptr) {
    top.fail_at(root_, ErrorCode::missing_key,
                "the bank is empty; it needs [[programs]] or [drums]");
    keep(top.finish());
  }
  if (!error_) read_programs(top);
  if (!error_) read_drums(top);
  if (error_) return *error_;
  return std::move(bank_);
}

void BankReader::read_programs(TableReader& top) {
  const Node* programs = top.array("programs");
  if (programs == nullptr) return;
  int number = 0;
  for (const Node& table : programs->items) {
    read_program(table, ++number);
    if (error_) return;
  }
}

void BankReader::read_program(const Node& table, int number) {
  TableReader reader(table, source_, "program entry " + std::to_string(number));
  BankEntry entry;
  int patch = 0;
  const Range programs = read_range(reader, "program", {});
  entry.program_low = programs.low;
  entry.program_high = programs.high;
  if (const Node* bank = reader.array("bank"); bank != nullptr) {
    const std::vector<double> bytes = reader.numbers("bank");
    const bool good =
        bytes.size() == 2 && std::all_of(bank->items.begin(), bank->items.end(), [](const Node& b) {
          return b.kind == Node::Kind::integer && b.integer >= 0 && b.integer <= 127;
        });
    if (good) {
      entry.bank_msb = static_cast<int>(bytes[0]);
      entry.bank_lsb = static_cast<int>(bytes[1]);
    } else {
      reader.fail_at(*bank, ErrorCode::value_out_of_range,
                     "bank must be [MSB, LSB], each 0 to 127 (CC 0 and CC 32)");
    }
  }
  read_entry(reader, entry, patch);
  add(reader, table, entry, patch);
  keep(reader.finish());
}

void BankReader::read_drums(TableReader& top) {
  bank_.drum_channel = 0;
  const Node* drums = top.table("drums");
  if (drums == nullptr) return;
  TableReader reader(*drums, source_, "drums");
  bank_.drum_channel = reader.integer("channel", 10, 1, 16);
  const Node* keys = reader.array("keys");
  if (keys == nullptr) {
    reader.fail_at(*drums, ErrorCode::missing_key, "there are no [[drums.keys]]");
  }
  keep(reader.finish());
  if (keys == nullptr) return;
  int number = 0;
  for (const Node& table : keys->items) {
    if (error_) return;
    read_drum_keys(table, ++number);
  }
}

void BankReader::read_drum_keys(const Node& table, int number) {
  TableReader reader(table, source_, "drum entry " + std::to_string(number));
  BankEntry entry;
  int patch = 0;
  if (reader.node("key") == nullptr) {
    reader.fail_at(table, ErrorCode::missing_key, "'key' is missing");
  }
  const Range keys = read_range(reader, "key", {});
  entry.note = reader.number("note", -1, 0, 127);
  entry.choke_group = reader.integer("choke", 0, 1, 127);
  read_entry(reader, entry, patch);
  for (int key = keys.low; key <= keys.high && reader.ok(); ++key) {
    entry.key = key;
    add(reader, *reader.node("key"), entry, patch);
  }
  keep(reader.finish());
}

void BankReader::read_entry(TableReader& reader, BankEntry& entry, int& patch) {
  entry.gain_db = reader.number("gain_db", 0, -96, 24);
  entry.transpose_semitones = reader.number("transpose", 0, -96, 96);
  const std::string name = reader.string("patch");
  if (!reader.ok()) return;
  entry.patch_file = FileShelf::beside(source_, name);
  patch = patch_index(reader, *reader.node("patch"), entry.patch_file);
}

int BankReader::patch_index(TableReader& reader, const Node& at, const std::string& path) {
  const std::string file = shelf_.canonical(path);
  if (const auto known = patch_by_file_.find(file); known != patch_by_file_.end()) {
    return known->second;
  }
  const auto text = shelf_.read(path);
  if (!text) {
    reader.fail_at(at, text.error().code, text.error().message);
    return 0;
  }
  const FileShelf::Link link(shelf_, path);
  auto patch = parse_patch_text(*text, path, shelf_);
  if (!patch) {
    keep(patch.error());
    return 0;
  }
  bank_.patches.push_back(std::move(*patch));
  return patch_by_file_[file] = static_cast<int>(bank_.patches.size()) - 1;
}

void BankReader::add(TableReader& reader, const Node& at, const BankEntry& entry, int patch) {
  if (!reader.ok() || error_) return;
  const auto same = std::find_if(bank_.entries.begin(), bank_.entries.end(),
                                 [&](const BankEntry& other) { return overlap(other, entry); });
  if (same != bank_.entries.end()) {
    const std::string programs =
        "program " + std::to_string(std::max(entry.program_low, same->program_low));
    reader.fail_at(at, ErrorCode::duplicate_name,
                   (entry.key >= 0 ? "key " + std::to_string(entry.key) : programs) +
                       " has a patch already, " + same->patch_file);
    return;
  }
  if (static_cast<int>(bank_.entries.size()) >= kMaxEntries) {
    reader.fail_at(at, ErrorCode::value_out_of_range,
                   "a bank has at most " + std::to_string(kMaxEntries) + " entries");
    return;
  }
  bank_.entries.push_back(entry);
  bank_.entry_patch.push_back(patch);
}

}  // namespace knotwave::engine
