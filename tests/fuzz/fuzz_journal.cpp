// SPDX-License-Identifier: MIT
// Any bytes as a journal: either an error with a place and a message, or a journal whose text reads
// back to the same text and whose events are in order.
#include <cstddef>
#include <cstdint>

#include "knotwave/engine/journal.h"

#include "fuzz_check.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace knotwave;
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const auto journal = engine::read_journal(text, "fuzz.journal");
  if (!journal) {
    fuzz::check_error(journal.error());
    return 0;
  }
  FUZZ_CHECK(journal->first >= 0 && journal->first <= journal->end);
  base::SampleTime last;
  for (const engine::Event& event : engine::journal_events(*journal)) {
    FUZZ_CHECK(event.time() >= last);
    last = event.time();
  }
  for (const engine::JournalRecord& record : journal->records) {
    const bool installs = record.kind == engine::Event::Kind::install_bank;
    FUZZ_CHECK(!installs || record.index < journal->banks.size());
  }
  const std::string again = engine::write_journal(*journal);
  const auto twice = engine::read_journal(again, "again.journal");
  FUZZ_CHECK(twice.has_value());
  FUZZ_CHECK(engine::write_journal(*twice) == again);
  return 0;
}
