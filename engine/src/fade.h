// SPDX-License-Identifier: MIT
// A gain that goes from 0 to 1 or back along the smoothest step, placed on the absolute sample
// index.
#pragma once
#include <algorithm>
#include <cstdint>

#include "knotwave/base/rt.h"

namespace knotwave::engine {

/// Two ways at once, multiplied: one in, one out. All [audio]. Until begun it is 1.
class Fade {
 public:
  void reset() KNOTWAVE_RT { *this = {}; }
  void begin_in(std::int64_t sample, std::int64_t samples) KNOTWAVE_RT {
    in_ = {sample, std::max<std::int64_t>(samples, 1)};
  }
  /// An end that is nearer already stays.
  void begin_out(std::int64_t sample, std::int64_t samples) KNOTWAVE_RT {
    if (is_out() && out_.end() <= sample + samples) return;
    out_ = {sample, std::max<std::int64_t>(samples, 1)};
  }
  double at(std::int64_t sample) const KNOTWAVE_RT {
    return (in_.samples == 0 ? 1 : in_.risen(sample)) *
           (out_.samples == 0 ? 1 : 1 - out_.risen(sample));
  }
  bool is_out() const KNOTWAVE_RT { return out_.samples != 0; }
  /// Not 1 throughout from `first` on.
  bool is_moving(std::int64_t first) const KNOTWAVE_RT {
    return is_out() || (in_.samples != 0 && first < in_.end());
  }
  /// Faded out before `sample`: nothing is heard from there on.
  bool is_over(std::int64_t sample) const KNOTWAVE_RT { return is_out() && sample >= out_.end(); }

 private:
  struct Way {
    std::int64_t start = 0, samples = 0;
    std::int64_t end() const KNOTWAVE_RT { return start + samples; }
    double risen(std::int64_t sample) const KNOTWAVE_RT {
      const double t =
          std::clamp(static_cast<double>(sample - start) / static_cast<double>(samples), 0.0, 1.0);
      return t * t * t * (10 + t * (6 * t - 15));
    }
  };
  Way in_, out_;
};

}  // namespace knotwave::engine
