// SPDX-License-Identifier: MIT
// Reads and compiles patches on a thread of its own, so that nothing waits for it.
#pragma once
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "knotwave/engine/journal.h"

#include "bank_input/bank_input.h"

namespace knotwave::synth {

/// A bank with what it was made of.
struct PlayableBank {
  std::string path;
  bank_input::BankInput input;
  engine::JournalBank source;  ///< for the journal: the bytes of the files
};
/// Errors: those of bank_input::read() and of reading files.
Result<PlayableBank> read_playable(const std::string& path);
/// Everything a bank was read from, sounds included.
std::vector<std::string> files_of(const PlayableBank& bank);

class BankLoader {
 public:
  struct Loaded {
    std::string path;
    Result<PlayableBank> bank;
  };

  BankLoader();
  BankLoader(const BankLoader&) = delete;
  BankLoader& operator=(const BankLoader&) = delete;
  /// Waits for what is being compiled just now.
  ~BankLoader();

  /// A newer wish replaces one that was not begun yet.
  void request(const std::string& path);
  /// What became of a wish, each once.
  std::optional<Loaded> take();

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable more_;
  std::optional<std::string> wish_;
  std::optional<Loaded> done_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace knotwave::synth
