// SPDX-License-Identifier: MIT
#include "bank_loader.h"

#include <atomic>
#include <chrono>
#include <utility>

#include "take/take.h"

namespace knotwave::synth {
namespace {

constexpr std::chrono::milliseconds kEndsWithin{500};
std::atomic<int> threads_under_way{0};

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
  auto input = bank_input::read(path);
  if (!input) return std::move(input).error();
  bank.input = *std::move(input);
  auto source = take::journal_bank(bank.input);
  if (!source) return std::move(source).error();
  bank.source = *std::move(source);
  return bank;
}

BankLoader::BankLoader()
    : thread_([shared = shared_] {
        ++threads_under_way;
        run(*shared);
        --threads_under_way;
        const std::lock_guard lock(shared->mutex);
        shared->has_ended = true;
        shared->changed.notify_all();
      }) {}

BankLoader::~BankLoader() {
  std::unique_lock lock(shared_->mutex);
  shared_->is_over = true;
  shared_->changed.notify_all();
  const bool has_ended =
      shared_->changed.wait_for(lock, kEndsWithin, [this] { return shared_->has_ended; });
  lock.unlock();
  if (has_ended) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

bool BankLoader::is_any_under_way() noexcept { return threads_under_way > 0; }

void BankLoader::request(const std::string& path) {
  const std::lock_guard lock(shared_->mutex);
  shared_->wish = path;
  shared_->changed.notify_all();
}

std::optional<BankLoader::Loaded> BankLoader::take() {
  const std::lock_guard lock(shared_->mutex);
  return std::exchange(shared_->done, std::nullopt);
}

void BankLoader::run(Shared& shared) {
  std::unique_lock lock(shared.mutex);
  for (;;) {
    shared.changed.wait(lock, [&shared] { return shared.is_over || shared.wish; });
    if (shared.is_over) return;
    const std::string path = *std::exchange(shared.wish, std::nullopt);
    lock.unlock();
    Loaded loaded{path, read_playable(path)};
    lock.lock();
    shared.done.emplace(std::move(loaded));
  }
}

}  // namespace knotwave::synth
