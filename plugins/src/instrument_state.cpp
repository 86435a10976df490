// SPDX-License-Identifier: MIT
// The instrument as text.
#include "knotwave/engine/journal.h"
#include "knotwave/plugins/instrument.h"

namespace knotwave::plugins {
namespace {

using engine::Event;
using engine::Journal;
using engine::JournalRecord;

constexpr const char* kSource = "the plugin's state";

Error malformed(std::string message) {
  Error error = fail(ErrorCode::malformed, std::move(message));
  error.source = kSource;
  return error;
}

std::size_t parameter_of_slot(std::uint32_t slot) {
  const auto all = Instrument::table().all();
  std::size_t place = 0;
  while (place < all.size() && static_cast<std::uint32_t>(all[place].slot) != slot) ++place;
  return place;
}

Result<void> check(const Journal& journal) {
  if (journal.banks.size() != 1) return malformed("one patch or bank must be in it");
  if (!journal.banks[0].sounds.empty()) return malformed("a plugin plays no sound files");
  for (const JournalRecord& record : journal.records) {
    if (record.kind != Event::Kind::set_target || !record.every_channel ||
        record.time != base::SampleTime{}) {
      return malformed("only targets of every channel at time 0 may be in it");
    }
    if (parameter_of_slot(record.index) == Instrument::table().size()) {
      return malformed("there is no parameter for slot " + std::to_string(record.index));
    }
  }
  return {};
}

}  // namespace

std::string Instrument::state() const {
  Journal journal;
  journal.max_voices = config_.max_voices;
  journal.banks.push_back({spec_.source_name, spec_.texts, {}});
  for (std::size_t i = 0; i < table().size(); ++i) {
    if (parameter(i) == table()[i].initial) continue;
    JournalRecord& record = journal.records.emplace_back();
    record.kind = Event::Kind::set_target;
    record.every_channel = true;
    record.index = static_cast<std::uint32_t>(table()[i].slot);
    record.number = parameter(i);
  }
  return engine::write_journal(journal);
}

Result<void> Instrument::load_state(std::string_view text) {
  auto journal = engine::read_journal(text, kSource);
  if (!journal) return journal.error();
  if (auto checked = check(*journal); !checked) return checked.error();
  const engine::JournalBank& bank = journal->banks[0];
  auto spec = engine::read_bank(bank.path, bank.files);
  if (!spec) return spec.error();
  if (auto loaded = load(*std::move(spec)); !loaded) return loaded.error();
  std::array<double, ParameterValues::kMost> values{};
  for (std::size_t i = 0; i < table().size(); ++i) values[i] = table()[i].initial;
  for (const JournalRecord& record : journal->records) {
    values[parameter_of_slot(record.index)] = record.number;
  }
  for (std::size_t i = 0; i < table().size(); ++i) set_parameter(i, values[i]);
  return {};
}

}  // namespace knotwave::plugins
