// SPDX-License-Identifier: MIT
// A bank as its file says it: which patch plays which program and drum key. [control]
#pragma once
#include <span>
#include <string>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/engine/patch.h"

namespace knotwave::engine {

/// Which patch plays a program or a drum key.
struct BankEntry {
  std::string patch_file;
  int bank_msb = -1, bank_lsb = -1;  ///< -1 = any
  int program_low = 0, program_high = 127;
  int key = -1;      ///< drums: the key; -1 = melodic
  double note = -1;  ///< drums: the note the patch sounds; -1 = the key
  double gain_db = 0;
  double transpose_semitones = 0;
  int choke_group = 0;  ///< drums: a new note of the same group silences the old
};
/// A file with what was in it.
struct FileText {
  std::string path;
  std::string bytes;
};
struct BankSpec {
  std::string name;
  std::string source_name;
  double gain_db = 0;
  std::vector<BankEntry> entries;
  int drum_channel = 10;           ///< 1..16, 0 = none
  std::vector<PatchSpec> patches;  ///< one for each different patch_file, in order of first use
  std::vector<int> entry_patch;    ///< [entries.size()] index into patches
  /// What read_bank() read besides `source_name`: patches, curve files, tunings.
  std::vector<std::string> files;
  /// `source_name` and `files` with what was in them, as they were read (of texts: those that were
  /// needed); none of parse_patch().
  std::vector<FileText> texts;
};

/// Reads a patch or a bank and every file it names, each once (sound files are only checked to
/// exist). A patch becomes a bank of one entry that plays all programs, and no drum channel, so
/// that it plays channel 10 too. Errors: those of curve files, unknown_name, duplicate_name,
/// cyclic_reference, control_conflict, not_scalar, not_a_function, file_not_found, unsupported
/// (kind "envelope"); all with file, line and column.
Result<BankSpec> read_bank(const std::string& path);
/// The same from texts in place of the disk: BankSpec::texts of an earlier reading give the same
/// bank again, whatever became of the files. A file that is not among them is not found.
Result<BankSpec> read_bank(const std::string& path, std::span<const FileText> texts);

/// A bank of one entry that plays `patch` for every program and for drums.
BankSpec bank_of(PatchSpec patch);

}  // namespace knotwave::engine
