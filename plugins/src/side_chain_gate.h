// SPDX-License-Identifier: MIT
// Audio to a gate. It opens at the sample that reaches the threshold, and closes where nothing came
// within `hysteresis` below it for as long as it holds. All [audio].
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "knotwave/base/elementary.h"
#include "knotwave/base/rt.h"

namespace knotwave::plugins {

class SideChainGate {
 public:
  void set(double threshold_db, double hysteresis_db, double hold_s, double rate_hz) KNOTWAVE_RT {
    opens_ = static_cast<float>(base::db_to_gain(threshold_db));
    keeps_ = static_cast<float>(base::db_to_gain(threshold_db - hysteresis_db));
    hold_samples_ = static_cast<std::int64_t>(std::floor(std::max(hold_s, 0.0) * rate_hz + 0.5));
  }
  void reset() KNOTWAVE_RT {
    is_open_ = false;
    quiet_samples_ = 0;
  }
  bool is_open() const KNOTWAVE_RT { return is_open_; }
  /// True: it opened or closed with this sample. NaN is silence.
  bool hear(float left, float right) KNOTWAVE_RT {
    const float level =
        std::max(left == left ? std::abs(left) : 0.0F, right == right ? std::abs(right) : 0.0F);
    const bool was_open = is_open_;
    quiet_samples_ = level >= (is_open_ ? keeps_ : opens_) ? 0 : quiet_samples_ + 1;
    is_open_ = is_open_ ? quiet_samples_ <= hold_samples_ : quiet_samples_ == 0;
    return is_open_ != was_open;
  }

 private:
  float opens_ = 1, keeps_ = 1;
  std::int64_t hold_samples_ = 0;
  std::int64_t quiet_samples_ = 0;
  bool is_open_ = false;
};

}  // namespace knotwave::plugins
