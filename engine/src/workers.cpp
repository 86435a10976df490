// SPDX-License-Identifier: MIT
#include "workers.h"

#include <string>
#include <system_error>

#include "knotwave/base/fp_state.h"

#include "futex.h"

namespace knotwave::engine {

Result<std::unique_ptr<Workers>> Workers::start(int threads) {
  std::unique_ptr<Workers> workers(new Workers);
  workers->pool_.reserve(static_cast<std::size_t>(threads - 1));
  try {
    for (int t = 1; t < threads; ++t) {
      workers->pool_.emplace_back([self = workers.get(), t] { self->serve(t); });
    }
  } catch (const std::system_error& fault) {
    const int started = workers->threads();
    return fail(ErrorCode::value_out_of_range,
                "the number of threads is " + std::to_string(threads) + "; this system starts " +
                    std::to_string(started) + " and no more: " + fault.code().message());
  }
  return workers;
}

Workers::~Workers() {
  stop_.store(true, std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  wake_all(round_);
  for (std::thread& thread : pool_) thread.join();
}

void Workers::run(Job job, void* context) noexcept {
  job_ = job;
  context_ = context;
  still_working_.store(static_cast<std::uint32_t>(pool_.size()), std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  wake_all(round_);
  job(context, 0);
  for (std::uint32_t left = still_working_.load(std::memory_order_acquire); left != 0;) {
    left = wait_while(still_working_, left);
  }
}

void Workers::serve(int thread) noexcept {
  const base::FpStateGuard state;
  std::uint32_t seen = 0;
  for (;;) {
    seen = wait_while(round_, seen);
    if (stop_.load(std::memory_order_relaxed)) return;
    job_(context_, thread);
    if (still_working_.fetch_sub(1, std::memory_order_acq_rel) == 1) wake_all(still_working_);
  }
}

}  // namespace knotwave::engine
