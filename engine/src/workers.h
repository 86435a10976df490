// SPDX-License-Identifier: MIT
// Threads that render voices side by side. They change nothing but speed: who renders which voice
// is fixed by its index, every voice has its own buffer, and one thread mixes.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/base/rt.h"

namespace knotwave::engine {

class Workers {
 public:
  using Job = void (*)(void* context, int thread);

  /// [control] `threads` in all, the caller of run() included: threads - 1 are started. Errors:
  /// value_out_of_range (the system starts fewer; those are ended again).
  static Result<std::unique_ptr<Workers>> start(int threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int threads() const KNOTWAVE_RT { return static_cast<int>(pool_.size()) + 1; }
  /// job(context, 0) here and job(context, t) on thread t, until all are done. One futex wake and,
  /// where the others take longer, a futex wait; no other system call. [audio]
  void run(Job job, void* context) noexcept;

 private:
  Workers() = default;
  void serve(int thread) noexcept;

  Job job_ = nullptr;
  void* context_ = nullptr;
  std::atomic<std::uint32_t> round_{0};
  std::atomic<std::uint32_t> still_working_{0};
  std::atomic<bool> stop_{false};
  std::vector<std::thread> pool_;
};

}  // namespace knotwave::engine
