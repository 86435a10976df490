// SPDX-License-Identifier: MIT
#include "stream_opener.h"

#include <atomic>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

namespace knotwave::synth {
namespace {

std::atomic<int> tries_under_way{0};

}  // namespace

bool StreamOpener::is_any_under_way() noexcept { return tries_under_way > 0; }

struct StreamOpener::Try {
  std::mutex mutex;
  std::optional<Opened> opened;
  bool is_wanted = true;
};

StreamOpener::~StreamOpener() {
  if (!try_) return;
  const std::lock_guard lock(try_->mutex);
  try_->is_wanted = false;
}

void StreamOpener::begin(const io::AudioConfig& config, io::AudioClient& client) {
  if (try_) return;
  try_ = std::make_shared<Try>();
  ++tries_under_way;
  try {
    std::thread([config, &client, shared = try_] {
      // Opened, not started: it asks the client for nothing yet.
      std::optional<Opened> opened = io::AudioStream::open(config, client);
      {
        const std::lock_guard lock(shared->mutex);
        if (shared->is_wanted) shared->opened = std::exchange(opened, std::nullopt);
      }
      opened.reset();
      --tries_under_way;
    }).detach();
  } catch (const std::system_error&) {
    --tries_under_way;
    try_.reset();
  }
}

std::optional<StreamOpener::Opened> StreamOpener::take() {
  if (!try_) return std::nullopt;
  std::optional<Opened> opened;
  {
    const std::lock_guard lock(try_->mutex);
    if (!try_->opened) return std::nullopt;
    opened = std::exchange(try_->opened, std::nullopt);
  }
  try_.reset();
  return opened;
}

}  // namespace knotwave::synth
