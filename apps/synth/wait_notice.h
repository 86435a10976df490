// SPDX-License-Identifier: MIT
// Says what is waited for, where it takes so long that one would wonder.
#pragma once
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace knotwave::synth {

/// One line on standard error when it has lived for 0.7 s; nothing before. [control]
class WaitNotice {
 public:
  explicit WaitNotice(std::string line);
  WaitNotice(const WaitNotice&) = delete;
  WaitNotice& operator=(const WaitNotice&) = delete;
  ~WaitNotice();

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace knotwave::synth
