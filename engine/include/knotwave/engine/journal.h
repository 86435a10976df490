// SPDX-License-Identifier: MIT
// A performance as what happened when, from engine time 0: played again, it gives the same samples.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/engine/event.h"

namespace knotwave::engine {

/// One thing that happened, of fixed size.
struct JournalRecord {
  base::SampleTime time;  ///< as the engine was given it
  Event::Kind kind = Event::Kind::midi;
  std::uint8_t bytes[3] = {0, 0, 0};
  std::uint8_t sysex_size = 0;
  std::uint32_t index = 0;  ///< set_target: the slot; install_bank: which of Journal::banks
  double number = 0;        ///< tempo, set_target
  std::array<std::uint8_t, 24> sysex{};
};

/// A bank as it was when it was installed: every file it was read from, with what was in it.
struct JournalBank {
  struct File {
    std::string path;
    std::string bytes;
  };
  std::string path;         ///< of the bank or patch, one of the files
  std::vector<File> files;  ///< text files, and sounds by their SHA-256 alone
};

struct Journal {
  double rate_hz = 48000;
  int max_voices = 128;
  std::uint64_t seed = 1;
  double volume_db = 0;
  std::vector<JournalBank> banks;  ///< the first is the one at engine time 0
  std::vector<JournalRecord> records;
  std::int64_t first = 0, end = 0;  ///< the take, in samples of engine time
  std::string sha256;               ///< of the take's interleaved float32 samples; empty: unknown
};

/// As text (docs/journal-format.md), one record a line. [control]
std::string write_journal(const Journal& journal);
/// Errors: those of documents, with line and column; unsupported_version. [control]
Result<Journal> read_journal(std::string_view text, const std::string& source_name);

}  // namespace knotwave::engine
