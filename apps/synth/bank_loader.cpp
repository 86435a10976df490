// SPDX-License-Identifier: MIT
#include "bank_loader.h"

#include <utility>

namespace knotwave::synth {

BankLoader::BankLoader() : thread_([this] { run(); }) {}

BankLoader::~BankLoader() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  more_.notify_one();
  thread_.join();
}

void BankLoader::request(const std::string& path) {
  {
    const std::lock_guard lock(mutex_);
    wish_ = path;
  }
  more_.notify_one();
}

std::optional<LoadedBank> BankLoader::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(done_, std::nullopt);
}

void BankLoader::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    more_.wait(lock, [this] { return is_over_ || wish_; });
    if (is_over_) return;
    const std::string path = *std::exchange(wish_, std::nullopt);
    lock.unlock();
    LoadedBank loaded{path, bank_input::read(path)};
    lock.lock();
    done_.emplace(std::move(loaded));
  }
}

}  // namespace knotwave::synth
