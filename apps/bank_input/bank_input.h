// SPDX-License-Identifier: MIT
// A patch or bank with every file it names, read and compiled: what is played and what is checked.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "knotwave/engine/bank_program.h"

namespace knotwave::bank_input {

struct BankInput {
  engine::BankSpec spec;
  std::unique_ptr<const engine::BankProgram> program;
  std::vector<engine::WaveCycles> waves;  ///< what `program` was compiled with
  std::vector<std::string> sounds;        ///< the sound files that were read
  std::vector<std::string> warnings;  ///< of the patches, then of the sounds; each names its file
};

/// Errors: those of read_bank(), of the sound files (at their place in the patch), of
/// BankProgram::create().
Result<BankInput> read(const std::string& path);
/// The same from texts that were kept (engine::BankSpec::texts) in place of the disk; sounds are
/// read from the disk.
Result<BankInput> read(const std::string& path, std::span<const engine::FileText> texts);

}  // namespace knotwave::bank_input
