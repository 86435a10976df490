// SPDX-License-Identifier: MIT
#include "take/take.h"

#include <algorithm>
#include <span>
#include <utility>

#include "knotwave/base/file.h"
#include "knotwave/base/sha256.h"

namespace knotwave::take {
namespace {

constexpr std::size_t kMaxSoundBytes = std::size_t{1} << 31;

Result<std::string> hash_of(const std::string& path) {
  const auto bytes = base::read_file(path, kMaxSoundBytes);
  if (!bytes) return bytes.error();
  base::Sha256 hash;
  hash.update(std::as_bytes(std::span(*bytes)));
  return hash.finish_hex();
}

}  // namespace

Result<engine::JournalBank> journal_bank(const bank_input::BankInput& input) {
  engine::JournalBank bank;
  bank.path = input.spec.source_name;
  bank.files = input.spec.texts;
  for (const std::string& path : input.sounds) {
    auto hash = hash_of(path);
    if (!hash) return std::move(hash).error();
    bank.sounds.push_back({path, *std::move(hash)});
  }
  return bank;
}

Result<bank_input::BankInput> read_kept(const engine::JournalBank& bank) {
  auto input = bank_input::read(bank.path, bank.files);
  if (!input) return input;
  for (const std::string& path : input->sounds) {
    const auto kept = std::find_if(bank.sounds.begin(), bank.sounds.end(),
                                   [&](const auto& sound) { return sound.path == path; });
    const auto hash = hash_of(path);
    if (!hash) return hash.error();
    const std::string was = kept == bank.sounds.end() ? "nothing" : kept->sha256;
    if (*hash == was) continue;
    Error error = fail(ErrorCode::malformed,
                       "this is not the sound the take was played with: its "
                       "SHA-256 is " +
                           *hash + ", the journal says " + was);
    error.source = path;
    return error;
  }
  return input;
}

Result<engine::Journal> read_take(const std::string& path) {
  const auto text = base::read_file(path, kMaxJournalBytes);
  if (!text) return text.error();
  return engine::read_journal(*text, path);
}

Result<void> write_take(const std::string& path, const engine::Journal& journal) {
  return base::write_file(path, engine::write_journal(journal));
}

}  // namespace knotwave::take
