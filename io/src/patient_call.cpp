// SPDX-License-Identifier: MIT
#include "patient_call.h"

#include <memory>
#include <system_error>
#include <thread>

namespace knotwave::io {

PatientCall::Outcome PatientCall::run(std::chrono::milliseconds limit, std::function<void()> work) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  std::unique_lock lock(mutex_);
  if (is_stuck_ || !changed_.wait_until(lock, deadline, [this] { return !is_busy_; })) {
    return Outcome::refused;
  }
  const auto is_done = std::make_shared<bool>(false);
  try {
    std::thread([this, is_done, work = std::move(work)]() mutable {
      work();
      work = nullptr;  // what it owns goes before anyone is told
      const std::lock_guard done(mutex_);
      *is_done = true;
      is_busy_ = is_stuck_ = false;
      changed_.notify_all();
    }).detach();
  } catch (const std::system_error&) {
    return Outcome::refused;
  }
  is_busy_ = true;
  if (changed_.wait_until(lock, deadline, [&is_done] { return *is_done; })) return Outcome::done;
  is_stuck_ = true;
  return Outcome::hangs;
}

bool PatientCall::is_stuck() noexcept {
  const std::lock_guard lock(mutex_);
  return is_stuck_;
}

PatientCall& jack_calls() {
  static auto* const calls = new PatientCall;
  return *calls;
}

PatientCall& portaudio_calls() {
  static auto* const calls = new PatientCall;
  return *calls;
}

}  // namespace knotwave::io
