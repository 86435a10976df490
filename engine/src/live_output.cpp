// SPDX-License-Identifier: MIT
#include "live_output.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace knotwave::engine {
namespace {

constexpr std::size_t kMarks = 64;
constexpr std::size_t kPiece = 256;

}  // namespace

LiveTap::LiveTap(std::size_t frames) : frames_(frames), marks_(kMarks) {}

void LiveTap::begin_block() KNOTWAVE_RT {
  is_on_ = wanted_.load(std::memory_order_relaxed);
  if (!is_on_) in_run_ = false;
}

bool LiveTap::begin_run(std::int64_t time) KNOTWAVE_RT {
  // The mark before its frames: who sees them sees it.
  in_run_ = in_run_ || marks_.push({written_, time});
  return in_run_;
}

void LiveTap::write(std::int64_t first, std::span<const float> left,
                    std::span<const float> right) KNOTWAVE_RT {
  if (!is_on_) return;
  std::array<Frame, kPiece> piece;
  for (std::size_t at = 0; at < left.size();) {
    const std::size_t n = std::min(kPiece, left.size() - at);
    for (std::size_t i = 0; i < n; ++i) piece[i] = {left[at + i], right[at + i]};
    std::size_t taken = 0;
    if (frames_.size() < frames_.capacity() && begin_run(first + static_cast<std::int64_t>(at))) {
      taken = frames_.write(std::span(piece).first(n));
    }
    written_ += taken;
    if (taken < n) in_run_ = false;
    dropped_ += static_cast<std::int64_t>(n - taken);
    at += n;
  }
}

LiveEngine::Tap LiveTap::read(std::span<float> interleaved) KNOTWAVE_RT {
  LiveEngine::Tap tap;
  std::array<Frame, kPiece> piece;
  while (2 * tap.frames + 1 < interleaved.size()) {
    // What is in the ring first: then the marks of all of it can be seen.
    std::size_t n = std::min({kPiece, interleaved.size() / 2 - tap.frames, frames_.size()});
    if (!has_mark_) has_mark_ = marks_.pop(mark_);
    if (has_mark_ && mark_.position == read_) {
      if (tap.frames > 0) break;  // a gap: the rest comes with the next call
      read_time_ = mark_.time;
      has_mark_ = marks_.pop(mark_);
    }
    if (has_mark_) n = std::min<std::uint64_t>(n, mark_.position - read_);
    n = frames_.read(std::span(piece).first(n));
    if (n == 0) break;
    if (tap.frames == 0) tap.first = read_time_;
    for (std::size_t i = 0; i < n; ++i) {
      interleaved[2 * (tap.frames + i)] = piece[i].left;
      interleaved[2 * (tap.frames + i) + 1] = piece[i].right;
    }
    tap.frames += n;
    read_ += n;
    read_time_ += static_cast<std::int64_t>(n);
  }
  return tap;
}

void LiveFade::set(float gain_lin, float seconds) KNOTWAVE_RT {
  // NaN and negative numbers fade to nothing, at once.
  const float gain = gain_lin > 0 ? std::min(gain_lin, 1e3F) : 0.0F;
  const float time = seconds > 0 ? std::min(seconds, 3600.0F) : 0.0F;
  const std::uint64_t high = std::bit_cast<std::uint32_t>(time) | 0x80000000U;  // never 0
  wanted_.store(high << 32 | std::bit_cast<std::uint32_t>(gain), std::memory_order_relaxed);
}

void LiveFade::follow(double rate_hz) KNOTWAVE_RT {
  const std::uint64_t wanted = wanted_.load(std::memory_order_relaxed);
  if (wanted == heard_) return;
  heard_ = wanted;
  from_ = gain_;
  to_ = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(wanted)));
  const auto seconds = static_cast<double>(
      std::bit_cast<float>(static_cast<std::uint32_t>(wanted >> 32) & 0x7FFFFFFFU));
  way_ = 0;
  step_ = 1 / std::max(std::floor(seconds * rate_hz + 0.5), 1.0);
}

void LiveFade::apply(double rate_hz, std::span<float> left, std::span<float> right) KNOTWAVE_RT {
  follow(rate_hz);
  if (way_ >= 1 && gain_ == 1) return;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (way_ < 1) {
      way_ += step_;
      if (way_ > 1 - 1e-9) way_ = 1;
      const double risen = way_ * way_ * way_ * (10 + way_ * (6 * way_ - 15));
      gain_ = way_ == 1 ? to_ : from_ + (to_ - from_) * risen;
    }
    left[i] *= static_cast<float>(gain_);
    right[i] *= static_cast<float>(gain_);
  }
}

void LivePeak::add(std::span<const float> samples) KNOTWAVE_RT {
  float most = 0;
  for (const float sample : samples) most = std::max(most, std::abs(sample));
  float before = most_.load(std::memory_order_relaxed);
  // Fails only when it was taken just now: then these are the first since.
  if (most > before && !most_.compare_exchange_strong(before, most, std::memory_order_relaxed)) {
    most_.store(most, std::memory_order_relaxed);
  }
}

}  // namespace knotwave::engine
