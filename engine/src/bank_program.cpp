// SPDX-License-Identifier: MIT
#include "knotwave/engine/bank_program.h"

#include "knotwave/base/elementary.h"
#include "knotwave/engine/patch_program.h"

namespace knotwave::engine {

BankProgram::BankProgram() = default;
BankProgram::~BankProgram() = default;

Result<std::unique_ptr<const BankProgram>> BankProgram::create(const BankSpec& spec,
                                                               std::span<const WaveCycles> cycles) {
  std::unique_ptr<BankProgram> bank(new BankProgram);
  if (spec.entry_patch.size() != spec.entries.size()) {
    return fail(ErrorCode::dimension_mismatch,
                "bank '" + spec.name + "' has " + std::to_string(spec.entries.size()) +
                    " entries but patches for " + std::to_string(spec.entry_patch.size()));
  }
  for (const int patch : spec.entry_patch) {
    if (patch >= 0 && static_cast<std::size_t>(patch) < spec.patches.size()) continue;
    return fail(ErrorCode::value_out_of_range, "bank '" + spec.name + "' names patch " +
                                                   std::to_string(patch) + " of " +
                                                   std::to_string(spec.patches.size()));
  }
  for (const PatchSpec& patch : spec.patches) {
    if (!patch.has_sound) {
      return fail(ErrorCode::unsupported, "patch '" + patch.name + "' has no sound to play");
    }
    auto program = PatchProgram::create(patch, cycles);
    if (!program) return program.error();
    for (const std::string& line : (*program)->report()) {
      bank->report_.push_back(patch.name + ": " + line);
    }
    bank->patches_.push_back(*std::move(program));
  }
  bank->entries_ = spec.entries;
  bank->entry_patch_ = spec.entry_patch;
  for (const BankEntry& entry : spec.entries) {
    bank->entry_gain_.push_back(base::db_to_gain(entry.gain_db));
    if (entry.key >= 0) bank->has_drums_ = true;
  }
  bank->drum_channel_ = spec.drum_channel - 1;
  bank->gain_lin_ = base::db_to_gain(spec.gain_db);
  return std::unique_ptr<const BankProgram>(std::move(bank));
}

BankProgram::Choice BankProgram::choose(int channel, int bank_msb, int bank_lsb, int program,
                                        int key) const KNOTWAVE_RT {
  const bool drum = has_drums_ && channel == drum_channel_;
  // An entry for this very bank goes before one that names none, which every bank falls back to.
  for (const bool names_bank : {true, false}) {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const BankEntry& entry = entries_[i];
      if (drum ? entry.key != key : entry.key >= 0) continue;
      if (program < entry.program_low || program > entry.program_high) continue;
      const bool has_bank = entry.bank_msb >= 0 || entry.bank_lsb >= 0;
      const bool same_bank = (entry.bank_msb < 0 || entry.bank_msb == bank_msb) &&
                             (entry.bank_lsb < 0 || entry.bank_lsb == bank_lsb);
      if (has_bank != names_bank || !same_bank) continue;
      Choice choice;
      choice.patch = patches_[static_cast<std::size_t>(entry_patch_[i])].get();
      choice.note = (entry.note >= 0 ? entry.note : key) + entry.transpose_semitones;
      choice.gain_lin = entry_gain_[i];
      choice.choke_group = entry.choke_group;
      choice.drum = drum;
      return choice;
    }
  }
  Choice nothing;
  nothing.drum = drum;
  return nothing;
}

}  // namespace knotwave::engine
