// SPDX-License-Identifier: MIT
#include "bank_loader.h"

#include <utility>

#include "take/take.h"

namespace knotwave::synth {

std::vector<std::string> files_of(const PlayableBank& bank) {
  std::vector<std::string> files = bank.input.spec.files;
  files.insert(files.end(), bank.input.sounds.begin(), bank.input.sounds.end());
  files.push_back(bank.path);
  return files;
}

Result<PlayableBank> read_playable(const std::string& path) {
  PlayableBank bank;
  bank.path = path;
  auto input = bank_input::read(path);
  if (!input) return std::move(input).error();
  bank.input = *std::move(input);
  auto source = take::journal_bank(bank.input);
  if (!source) return std::move(source).error();
  bank.source = *std::move(source);
  return bank;
}

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

std::optional<BankLoader::Loaded> BankLoader::take() {
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
    Loaded loaded{path, read_playable(path)};
    lock.lock();
    done_.emplace(std::move(loaded));
  }
}

}  // namespace knotwave::synth
