// SPDX-License-Identifier: MIT
// A take's journal on the disk: what it keeps of a bank, and how it is read and written.
#pragma once
#include <string>

#include "knotwave/engine/journal.h"

#include "bank_input/bank_input.h"

namespace knotwave::take {

inline constexpr std::size_t kMaxJournalBytes = std::size_t{1} << 30;

/// What a journal keeps of a bank that was read. Errors: a sound file that cannot be read.
Result<engine::JournalBank> journal_bank(const bank_input::BankInput& input);

/// The bank again, from the texts that were kept and the sounds on the disk. Errors: those of
/// bank_input::read(); malformed (a sound is not what it was: the message has both SHA-256).
Result<bank_input::BankInput> read_kept(const engine::JournalBank& bank);

/// Errors: those of read_journal(), file_not_found, io_failed, file_too_large.
Result<engine::Journal> read_take(const std::string& path);
/// Complete or not at all. Errors: disk_full, io_failed.
Result<void> write_take(const std::string& path, const engine::Journal& journal);

}  // namespace knotwave::take
