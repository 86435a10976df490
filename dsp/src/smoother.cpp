// SPDX-License-Identifier: MIT
#include "knotwave/dsp/smoother.h"

#include <algorithm>

namespace knotwave::dsp {
namespace {

// The smoothest step backwards: what is still to go when w = 1 - t of the time is left. Exactly 0
// once no time is left.
constexpr double to_go(double w) {
  w = w > 0 ? (w < 1 ? w : 1.0) : 0.0;
  return w * w * w * (10 + w * (6 * w - 15));
}

}  // namespace

void Smoother::reset(double value, int samples) KNOTWAVE_RT {
  target_ = before_last_ = value == value ? value : 0;
  length_ = std::max(samples, 1);
  count_ = 0;
}

void Smoother::drop_finished(std::int64_t sample) KNOTWAVE_RT {
  int done = 0;
  while (done < count_ && moves_[static_cast<std::size_t>(done)].start + length_ <= sample) ++done;
  std::copy(moves_.begin() + done, moves_.begin() + count_, moves_.begin());
  count_ -= done;
}

void Smoother::set_target(double target, std::int64_t sample) KNOTWAVE_RT {
  if (target != target || target == target_) return;
  drop_finished(sample);
  const int spacing = (length_ + kMovesInLength - 1) / kMovesInLength;
  std::int64_t start = sample;
  if (count_ > 0) {
    Move& last = moves_[static_cast<std::size_t>(count_ - 1)];
    if (last.start >= sample) {  // it has not moved anything yet: only its aim changes
      last.step = target - before_last_;
      target_ = target;
      return;
    }
    start = std::max(sample, last.start + spacing);
  }
  KNOTWAVE_ASSERT(count_ <= kMovesInLength);
  moves_[static_cast<std::size_t>(count_++)] = {start, target - target_};
  before_last_ = target_;
  target_ = target;
}

double Smoother::value_at(std::int64_t sample) const KNOTWAVE_RT {
  double y = 0;
  fill(sample, std::span<double>(&y, 1));
  return y;
}

template <class Float>
void Smoother::fill(std::int64_t first, std::span<Float> out) const KNOTWAVE_RT {
  if (is_still(first)) {
    std::fill(out.begin(), out.end(), static_cast<Float>(target_));
    return;
  }
  const double per_sample = 1 / static_cast<double>(length_);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::int64_t n = first + static_cast<std::int64_t>(i);
    double y = target_;
    for (int k = 0; k < count_; ++k) {
      const Move& move = moves_[static_cast<std::size_t>(k)];
      y -= move.step * to_go(static_cast<double>(move.start + length_ - n) * per_sample);
    }
    out[i] = static_cast<Float>(y);
  }
}

void Smoother::render(std::int64_t first, std::span<float> out) const KNOTWAVE_RT {
  fill(first, out);
}
void Smoother::render(std::int64_t first, std::span<double> out) const KNOTWAVE_RT {
  fill(first, out);
}

}  // namespace knotwave::dsp
