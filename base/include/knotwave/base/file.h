// SPDX-License-Identifier: MIT
// Whole files in, whole files out: a file written here is complete or absent, and an old one is
// kept until the new one is complete. [control]
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "knotwave/base/result.h"

namespace knotwave::base {

/// Errors: file_not_found (the message suggests the nearest name in that folder), io_failed (a
/// folder, no permission, a pipe that nobody writes into for 5 s), file_too_large.
Result<std::string> read_file(const std::string& path, std::size_t max_bytes);

/// A file being written beside its final name as NAME.part-PID; a NAME too long for that is cut and
/// ends in a hash. commit() syncs and renames it; the destructor removes what was not committed,
/// and so does remove_unfinished_files().
class AtomicFile {
 public:
  /// Errors: io_failed, disk_full; the message names the folder and the reason. Parts that dead
  /// processes left beside the same name are swept.
  static Result<AtomicFile> create(const std::string& path);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  ~AtomicFile();

  const std::string& part_path() const { return part_path_; }  ///< what to write to
  int descriptor() const { return descriptor_; }               ///< open for reading and writing
  Result<void> write(std::span<const std::byte> bytes);
  /// fsync, rename over the final name, fsync of the folder. Errors: io_failed, disk_full.
  Result<void> commit();

 private:
  AtomicFile() = default;
  std::string path_, part_path_;
  int descriptor_ = -1;
  int slot_ = -1;  ///< place in the table remove_unfinished_files() reads
};

/// Removes every unfinished file of this process. Async-signal-safe: for signal handlers. [any]
void remove_unfinished_files() noexcept;

/// create, write, commit in one.
Result<void> write_file(const std::string& path, std::string_view bytes);

/// All of `bytes`, past the buffers of stdio. Errors: disk_full, io_failed (its reader has gone).
Result<void> write_to_standard_output(std::span<const std::byte> bytes);

/// Whether `path` ends in `ending` (".wav", in lower case), its ASCII letters in any case.
bool has_ending(std::string_view path, std::string_view ending) noexcept;

}  // namespace knotwave::base
