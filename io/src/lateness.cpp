// SPDX-License-Identifier: MIT
#include "knotwave/io/lateness.h"

#include <algorithm>
#include <bit>

namespace knotwave::io {
namespace {

constexpr std::size_t kBinsPerOctave = 8;

std::size_t bin_of(std::int64_t late_ns) KNOTWAVE_RT {
  const auto n = static_cast<std::uint64_t>(late_ns);
  if (n < kBinsPerOctave) return n;
  const auto shift = static_cast<std::size_t>(std::bit_width(n)) - 4;  // leaves 8..15
  return kBinsPerOctave * shift + (n >> shift);
}

std::int64_t highest_of(std::size_t bin) KNOTWAVE_RT {
  if (bin < kBinsPerOctave) return static_cast<std::int64_t>(bin);
  const std::size_t shift = bin / kBinsPerOctave - 1;
  const std::uint64_t first = kBinsPerOctave + bin % kBinsPerOctave;
  return static_cast<std::int64_t>(((first + 1) << shift) - 1);
}

}  // namespace

void Lateness::add(std::int64_t late_ns) KNOTWAVE_RT {
  late_ns = std::max<std::int64_t>(late_ns, 0);
  bins_[std::min(bin_of(late_ns), kBins - 1)].fetch_add(1, std::memory_order_relaxed);
  if (late_ns > max_ns_.load(std::memory_order_relaxed)) {
    max_ns_.store(late_ns, std::memory_order_relaxed);
  }
}

Lateness::Figures Lateness::figures() const KNOTWAVE_RT {
  std::array<std::int64_t, kBins> bins{};
  Figures figures;
  figures.max_ns = max_ns_.load(std::memory_order_relaxed);
  for (std::size_t i = 0; i < kBins; ++i) {
    bins[i] = bins_[i].load(std::memory_order_relaxed);
    figures.count += bins[i];
  }
  std::int64_t passed = 0;
  for (std::size_t i = 0; i < kBins && passed < figures.count; ++i) {
    const auto holds = [&](std::int64_t rank) { return passed < rank && passed + bins[i] >= rank; };
    const std::int64_t highest = std::min(highest_of(i), figures.max_ns);
    if (holds((figures.count + 1) / 2)) figures.median_ns = highest;
    if (holds(figures.count - figures.count / 100)) figures.p99_ns = highest;
    passed += bins[i];
  }
  return figures;
}

}  // namespace knotwave::io
