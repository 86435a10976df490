// SPDX-License-Identifier: MIT
// What a plugin's parameters are, set by any thread and heard by the audio thread at its blocks.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>

#include "knotwave/plugins/parameters.h"

namespace knotwave::plugins {

class ParameterValues {
 public:
  static constexpr std::size_t kMost = 128;
  /// [control] All at their initial values. At most kMost; the table stays.
  explicit ParameterValues(const ParameterTable& table);

  /// Held within its range; of a place that is not there nothing. [any]
  void set(std::size_t place, double value) KNOTWAVE_RT;
  double get(std::size_t place) const KNOTWAVE_RT;  ///< [any] 0 of a place that is not there

  // [audio]

  /// The audio thread's own: known as heard at once. The value as it is held.
  double set_heard(std::size_t place, double value) KNOTWAVE_RT;
  double heard(std::size_t place) const KNOTWAVE_RT { return heard_[place]; }
  /// Calls changed(place, value) for each that was set since, in order of places.
  template <class Changed>
  void take_news(Changed changed) KNOTWAVE_RT {
    if (!has_news_.exchange(false, std::memory_order_acquire)) return;
    for (std::size_t place = 0; place < table_->size(); ++place) {
      const double value = wanted_[place].load(std::memory_order_relaxed);
      if (value == heard_[place]) continue;
      heard_[place] = value;
      changed(place, value);
    }
  }
  /// [control] While no audio thread runs: heard are the initial values, the rest is news.
  void forget_heard();

 private:
  const ParameterTable* table_;
  std::array<std::atomic<double>, kMost> wanted_;
  std::atomic<bool> has_news_{true};  ///< some wanted_ may differ from heard_
  std::array<double, kMost> heard_{};
};

}  // namespace knotwave::plugins
