// SPDX-License-Identifier: MIT
#include "wait_notice.h"

#include <chrono>
#include <cstdio>
#include <system_error>
#include <utility>

namespace knotwave::synth {
namespace {

constexpr std::chrono::milliseconds kPatience{700};

}  // namespace

WaitNotice::WaitNotice(std::string line) {
  try {
    thread_ = std::thread([this, line = std::move(line)] {
      std::unique_lock lock(mutex_);
      if (ended_.wait_for(lock, kPatience, [this] { return is_over_; })) return;
      std::fprintf(stderr, "%s\n", line.c_str());
    });
  } catch (const std::system_error&) {  // who has no thread left waits without a word
  }
}

WaitNotice::~WaitNotice() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  ended_.notify_one();
  if (thread_.joinable()) thread_.join();
}

}  // namespace knotwave::synth
