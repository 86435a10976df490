// SPDX-License-Identifier: MIT
// Reads and compiles patches on a thread of its own, so that nothing waits for it.
#pragma once
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "bank_input/bank_input.h"

namespace knotwave::synth {

struct LoadedBank {
  std::string path;
  Result<bank_input::BankInput> bank;
};

class BankLoader {
 public:
  BankLoader();
  BankLoader(const BankLoader&) = delete;
  BankLoader& operator=(const BankLoader&) = delete;
  /// Waits for what is being compiled just now.
  ~BankLoader();

  /// A newer wish replaces one that was not begun yet.
  void request(const std::string& path);
  /// What became of a wish, each once.
  std::optional<LoadedBank> take();

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable more_;
  std::optional<std::string> wish_;
  std::optional<LoadedBank> done_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace knotwave::synth
