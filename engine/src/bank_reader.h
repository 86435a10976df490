// SPDX-License-Identifier: MIT
// Reads the tables of a bank. Private to the patch files. [control]
#pragma once
#include <map>
#include <optional>
#include <string>

#include "knotwave/engine/bank.h"

#include "patch_reader.h"

namespace knotwave::engine {

/// A patch of text, with the files it names; the caller has put `source` into the shelf's chain.
Result<PatchSpec> parse_patch_text(std::string_view text, const std::string& source,
                                   FileShelf& shelf);

class BankReader {
 public:
  BankReader(const base::Node& root, const std::string& source_name, FileShelf& shelf)
      : root_(root), source_(source_name), shelf_(shelf) {
    bank_.source_name = source_name;
  }
  Result<BankSpec> read();

 private:
  using Node = base::Node;
  using TableReader = base::TableReader;

  void read_programs(TableReader& top);
  void read_program(const Node& table, int number);
  void read_drums(TableReader& top);
  void read_drum_keys(const Node& table, int number);
  // `patch` and what both kinds of entry share.
  void read_entry(TableReader& reader, BankEntry& entry, int& patch);
  int patch_index(TableReader& reader, const Node& at, const std::string& path);
  void add(TableReader& reader, const Node& at, const BankEntry& entry, int patch);

  void keep(const Result<void>& result) {
    if (!error_ && !result) error_ = result.error();
  }

  const Node& root_;
  std::string source_;
  FileShelf& shelf_;
  BankSpec bank_;
  std::map<std::string, int> patch_by_file_;
  std::optional<Error> error_;
};

}  // namespace knotwave::engine
