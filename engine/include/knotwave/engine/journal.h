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
#include "knotwave/engine/bank.h"
#include "knotwave/engine/event.h"

namespace knotwave::engine {

/// One thing that happened, of fixed size.
struct JournalRecord {
  base::SampleTime time;  ///< as the engine was given it
  Event::Kind kind = Event::Kind::midi;
  std::uint8_t bytes[3] = {0, 0, 0};
  std::uint8_t sysex_size = 0;
  bool every_channel = false;          ///< set_target, set_note, choke
  bool is_expression = false;          ///< set_note
  std::int32_t note = Event::kNoNote;  ///< midi, set_note, choke
  std::uint32_t index = 0;  ///< set_target, set_note: the slot; install_bank: of Journal::banks
  double number = 0;        ///< tempo, set_target, set_note, position
  std::array<std::uint8_t, 24> sysex{};
};

/// A bank as it was when it was installed: every file it was read from, with what was in it.
struct JournalBank {
  /// Sounds are too large to be kept: only what tells whether they are still the same.
  struct Sound {
    std::string path;
    std::string sha256;  ///< of the file
  };
  using File = FileText;
  std::string path;             ///< of the bank or patch, one of the files
  std::vector<FileText> files;  ///< as BankSpec::texts
  std::vector<Sound> sounds;
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

/// As text (docs/journal-format.md), one record a line. Reading it back gives the same journal.
/// [control]
std::string write_journal(const Journal& journal);
/// Errors, with line and column: unsupported_version, malformed (cut off), syntax, missing_key,
/// wrong_type, value_out_of_range (a record earlier than the one before it included), unknown_name.
/// Memory is bounded by a few times the text. [control]
Result<Journal> read_journal(std::string_view text, const std::string& source_name);

/// The records as the engine's events, which point into the journal. The bank of each install_bank
/// is for the caller to set: a program compiled anew each time, as it was when it was played, for
/// an engine does nothing when it is given the bank it has. [control]
std::vector<Event> journal_events(const Journal& journal);

}  // namespace knotwave::engine
