// SPDX-License-Identifier: MIT
// One of several things (a curve, a law), exchanged for another while it sounds.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "knotwave/dsp/smoother.h"

namespace knotwave::plugins {

/// The old one fades into the new one along dsp::Smoother's step. What is chosen on the way begins
/// when that is over; of several the last. All [audio].
template <class Thing>
class Exchange {
 public:
  /// At once. A fade lasts `samples`, >= 1.
  void reset(const Thing* thing, int samples) KNOTWAVE_RT {
    from_ = to_ = wanted_ = thing;
    samples_ = samples;
    end_ = 0;
    weight_.reset(1, samples);
  }
  void choose(const Thing* thing) KNOTWAVE_RT { wanted_ = thing; }

  /// Before anything is rendered from sample `now` on: begins what waits.
  void begin(std::int64_t now) KNOTWAVE_RT {
    if (now < end_) return;
    from_ = to_;
    if (wanted_ == to_) return;
    to_ = wanted_;
    end_ = now + samples_;
    weight_.reset(0, samples_);
    weight_.set_target(1, now);
  }
  /// How many samples from `now` on need no other begin().
  std::size_t steady(std::int64_t now) const KNOTWAVE_RT {
    return now < end_ ? static_cast<std::size_t>(end_ - now)
                      : std::numeric_limits<std::size_t>::max();
  }

  bool is_still() const KNOTWAVE_RT { return from_ == to_; }
  const Thing& from() const KNOTWAVE_RT { return *from_; }
  const Thing& to() const KNOTWAVE_RT { return *to_; }
  /// How much of to() is heard at samples first.., 0..1; the rest is from().
  void weights(std::int64_t first, std::span<double> out) const KNOTWAVE_RT {
    weight_.render(first, out);
  }
  bool uses(const Thing& thing) const KNOTWAVE_RT {
    return from_ == &thing || to_ == &thing || wanted_ == &thing;
  }

 private:
  const Thing* from_ = nullptr;
  const Thing* to_ = nullptr;
  const Thing* wanted_ = nullptr;
  int samples_ = 1;
  std::int64_t end_ = 0;  ///< of the fade under way
  dsp::Smoother weight_;
};

}  // namespace knotwave::plugins
