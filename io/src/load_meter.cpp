// SPDX-License-Identifier: MIT
#include "load_meter.h"

#include <algorithm>

namespace knotwave::io {
namespace {

constexpr double kSmoothedOverNs = 1e9;

// There is one writer, so a read and a write do, without the bus lock of fetch_add.
template <class T>
void add(std::atomic<T>& counter, T amount) noexcept {
  counter.store(counter.load(std::memory_order_relaxed) + amount, std::memory_order_relaxed);
}

}  // namespace

void LoadMeter::count(std::int64_t busy_ns, std::int64_t length_ns) KNOTWAVE_RT {
  if (length_ns <= 0) return;
  busy_ns = std::max<std::int64_t>(busy_ns, 0);
  const double share = static_cast<double>(busy_ns) / static_cast<double>(length_ns);
  const double bin = std::min(share * kBinsPerDeadline, static_cast<double>(kBins - 1));
  add<std::int64_t>(bins_[static_cast<std::size_t>(bin)], 1);
  if (busy_ns > length_ns) add<std::int64_t>(overruns_, 1);
  if (share > max_.load(std::memory_order_relaxed)) max_.store(share, std::memory_order_relaxed);
  const double weight = std::min(1.0, static_cast<double>(length_ns) / kSmoothedOverNs);
  add(load_, (share - load_.load(std::memory_order_relaxed)) * weight);
}

LoadMeter::Figures LoadMeter::figures() const noexcept {
  Figures figures{.overruns = overruns_.load(std::memory_order_relaxed),
                  .load = load_.load(std::memory_order_relaxed),
                  .max = max_.load(std::memory_order_relaxed)};
  std::int64_t all = 0;
  for (const auto& bin : bins_) all += bin.load(std::memory_order_relaxed);
  std::int64_t longer = all;
  for (std::size_t i = 0; i < kBins && longer * 100 > all; ++i) {
    longer -= bins_[i].load(std::memory_order_relaxed);
    figures.p99 = static_cast<double>(i + 1) / kBinsPerDeadline;
    if (i + 1 == kBins) figures.p99 = figures.max;
  }
  figures.p99 = std::min(figures.p99, figures.max);
  return figures;
}

}  // namespace knotwave::io
