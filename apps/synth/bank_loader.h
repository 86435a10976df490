// SPDX-License-Identifier: MIT
// Reads and compiles patches on a thread of its own, so that nothing waits for it.
#pragma once
#include <condition_variable>
#include <memory>
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
  /// Waits for what is being compiled just now, half a second at most: who reads from a pipe is
  /// left behind.
  ~BankLoader();

  /// A newer wish replaces one that was not begun yet.
  void request(const std::string& path);
  /// What became of a wish, each once.
  std::optional<Loaded> take();
  /// Some loader's thread was left behind and is still under way. [any]
  static bool is_any_under_way() noexcept;

 private:
  /// Also the thread's.
  struct Shared {
    std::mutex mutex;
    std::condition_variable changed;
    std::optional<std::string> wish;
    std::optional<Loaded> done;
    bool is_over = false, has_ended = false;
  };
  static void run(Shared& shared);

  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
  std::thread thread_;
};

}  // namespace knotwave::synth
