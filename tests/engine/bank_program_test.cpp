// SPDX-License-Identifier: MIT
// Which patch a note is played by, and what is said when there is none.
#include "knotwave/engine/bank_program.h"

#include <gtest/gtest.h>

#include "knotwave/engine/channel_state.h"
#include "knotwave/engine/patch_program.h"

#include "scenes.h"

namespace knotwave::engine {
namespace {

using namespace scenes;  // NOLINT: the words of these tests

BankEntry entry(int program, int bank_msb = -1, int bank_lsb = -1) {
  BankEntry made;
  made.program_low = made.program_high = program;
  made.bank_msb = bank_msb;
  made.bank_lsb = bank_lsb;
  return made;
}

BankEntry drum(int key) {
  BankEntry made;
  made.key = key;
  return made;
}

/// A bank in which entry i plays a patch called "i".
std::unique_ptr<const BankProgram> bank_of_entries(const std::vector<BankEntry>& entries) {
  BankSpec spec;
  spec.entries = entries;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    auto patch = parse_patch(kPlain, "scene.toml");
    EXPECT_TRUE(patch);
    patch->name = std::to_string(i);
    spec.patches.push_back(*std::move(patch));
    spec.entry_patch.push_back(static_cast<int>(i));
  }
  auto bank = BankProgram::create(spec);
  EXPECT_TRUE(bank) << (bank ? "" : bank.error().to_string());
  return bank ? *std::move(bank) : nullptr;
}

std::string chosen(const BankProgram& bank, int msb, int lsb, int program, int channel = 0,
                   int key = 60) {
  const PatchProgram* patch = bank.choose(channel, msb, lsb, program, key).patch;
  return patch == nullptr ? "none" : patch->name();
}

TEST(BankProgram, AnEntryOfTheBankGoesBeforeOneWithoutWhateverTheOrder) {
  for (const bool bank_first : {false, true}) {
    const auto bank = bank_first ? bank_of_entries({entry(0, 1, 0), entry(0)})
                                 : bank_of_entries({entry(0), entry(0, 1, 0)});
    EXPECT_EQ(chosen(*bank, 1, 0, 0), bank_first ? "0" : "1");
    EXPECT_EQ(chosen(*bank, 0, 0, 0), bank_first ? "1" : "0");
    EXPECT_EQ(chosen(*bank, 1, 1, 0), bank_first ? "1" : "0");
  }
}

TEST(BankProgram, AnEntryOfOneBankPlaysInNoOther) {
  const auto bank = bank_of_entries({entry(0), entry(1, 1, 0)});
  EXPECT_EQ(chosen(*bank, 1, 0, 1), "1");
  EXPECT_EQ(chosen(*bank, 0, 0, 1), "none");
  EXPECT_EQ(chosen(*bank, 1, 1, 1), "none");
  EXPECT_EQ(chosen(*bank, 1, 0, 0), "0");
}

TEST(BankProgram, DrumKeysFollowNoBank) {
  const auto bank = bank_of_entries({entry(0), drum(36)});
  EXPECT_EQ(chosen(*bank, 5, 6, 7, 9, 36), "1");
  EXPECT_EQ(chosen(*bank, 0, 0, 0, 9, 37), "none");
  EXPECT_TRUE(bank->choose(9, 0, 0, 0, 37).drum);
}

TEST(BankProgram, NotesWithoutAPatchAreCountedAndTheFirstDifferentOnesNamed) {
  const auto bank = bank_of_entries({entry(0), drum(36)});
  const auto engine = engine_for(*bank);
  std::vector<Event> events = {control(0, 2, kBankMsb, 3), midi(0, 0xC2, 77, 0)};
  for (int i = 0; i < 3; ++i) events.push_back(on(1, 2, 60 + i));
  for (int key = 35; key <= 45; ++key) events.push_back(on(2, 9, key));
  play(*engine, events, 64);
  const EngineCounters& counters = engine->counters();
  EXPECT_EQ(counters.notes, 1);  // key 36
  EXPECT_EQ(counters.notes_without_patch, 3 + 10);
  ASSERT_EQ(counters.missing_count, EngineCounters::kMissingNamed);
  EXPECT_EQ(counters.missing[0], (MissingPatch{2, 3, 0, 77, -1}));
  EXPECT_EQ(counters.missing[1], (MissingPatch{9, 0, 0, 0, 35}));
  EXPECT_EQ(counters.missing[2], (MissingPatch{9, 0, 0, 0, 37}));
  EXPECT_EQ(counters.missing[3], (MissingPatch{9, 0, 0, 0, 38}));
}

}  // namespace
}  // namespace knotwave::engine
