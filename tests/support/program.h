// SPDX-License-Identifier: MIT
// Runs one of our programs as a user would and keeps what it said and what it cost.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace knotwave::support {

struct ProgramRun {
  int exit_code = -1;  ///< 128 + signal when a signal ended it
  std::string out;     ///< standard output, bytes
  std::string err;     ///< standard error
  double cpu_s = 0;    ///< user + system time of the child
  double wall_s = 0;
  long max_rss_kib = 0;  ///< largest resident size
};

struct ProgramOptions {
  double timeout_s = 120;         ///< killed after that; exit_code is then 137
  std::string folder;             ///< working directory; empty = ours
  double interrupt_after_s = 0;   ///< > 0: SIGINT after that time
  bool is_in_background = false;  ///< born with SIGINT ignored, as a shell's jobs behind &
  double kill_after_s = 0;        ///< > 0: SIGKILL after that time
  long max_file_bytes = -1;       ///< >= 0: RLIMIT_FSIZE
  long max_address_bytes = -1;    ///< >= 0: RLIMIT_AS
  /// Takes standard output as it comes instead of keeping it.
  std::function<void(std::span<const char>)> on_output;
};

/// argv[0] without a slash is looked for in the build's bin folder (KNOTWAVE_BIN_DIR). Standard
/// input is /dev/null.
ProgramRun run_program(const std::vector<std::string>& argv, const ProgramOptions& options = {});

/// A new empty folder that is removed with what is in it when the object goes.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace knotwave::support
