// SPDX-License-Identifier: MIT
#include "bank_loader.h"

#include <ctime>
#include <utility>

#include <sys/stat.h>

#include "take/take.h"

namespace knotwave::synth {
namespace {

constexpr int kTries = 5;

/// By the clock that files are stamped with.
timespec file_time() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME_COARSE, &now);
  return now;
}

bool is_saved_since(const PlayableBank& bank, timespec start) {
  for (const std::string& path : files_of(bank)) {
    struct stat info {};
    if (::stat(path.c_str(), &info) != 0) return true;
    const timespec& saved = info.st_mtim;
    if (saved.tv_sec > start.tv_sec) return true;
    if (saved.tv_sec == start.tv_sec && saved.tv_nsec >= start.tv_nsec) return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> files_of(const PlayableBank& bank) {
  std::vector<std::string> files = bank.input.spec.files;
  files.insert(files.end(), bank.input.sounds.begin(), bank.input.sounds.end());
  files.push_back(bank.path);
  return files;
}

Result<PlayableBank> read_playable(const std::string& path) {
  PlayableBank bank;
  bank.path = path;
  for (int i = 0; i < kTries; ++i) {
    const timespec start = file_time();
    auto input = bank_input::read(path);
    if (!input) return std::move(input).error();
    bank.input = *std::move(input);
    auto source = take::journal_bank(bank.input);
    if (!source) return std::move(source).error();
    bank.source = *std::move(source);
    // What was compiled and what was read for the journal must be the same text.
    if (!is_saved_since(bank, start)) break;
  }
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
