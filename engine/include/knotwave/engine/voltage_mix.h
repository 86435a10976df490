// SPDX-License-Identifier: MIT
// What the patches of an envelope generator put on each channel of control voltage: their outputs
// to = "cv" and, added to these, the gates of their events.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "knotwave/engine/envelope_player.h"

namespace knotwave::engine {

class VoltageMix {
 public:
  static constexpr std::size_t kMostSamples = EnvelopePlayer::kMostSamples;

  /// [control] The programs must outlive it.
  explicit VoltageMix(std::span<const EnvelopePatchProgram* const> patches);

  /// Channels 1 to the highest that a patch names. [any]
  std::size_t channels() const KNOTWAVE_RT { return volts_.size(); }

  // A block, all [audio]: begin(), what the players tell, end().

  /// Samples first..first+n-1, n <= kMostSamples.
  void begin(std::int64_t first, std::size_t n) KNOTWAVE_RT;
  /// Of messages only the gates, in order of time; those before the block hold from its begin.
  void hear(std::size_t patch, const PlayerMessage& message) KNOTWAVE_RT;
  /// `values(patch, output)`: volts of the block's samples, [n] or more.
  template <class Values>
  void end(Values values) KNOTWAVE_RT {
    for (std::size_t patch = 0; patch < done_.size(); ++patch) fill_gates(patch, n_);
    for (auto& volts : volts_) volts.fill(0);
    for (const Route& route : routes_) {
      const std::span<const double> from = values(route.patch, route.output);
      for (std::size_t i = 0; i < n_; ++i) volts_[route.channel][i] += from[i];
    }
    for (std::size_t c = 0; has_gates_ && c < volts_.size(); ++c) {
      for (std::size_t i = 0; i < n_; ++i) volts_[c][i] += gate_volts_[c][i];
    }
  }
  /// Of a channel from 0, [n], until the next begin().
  std::span<const double> volts(std::size_t channel) const KNOTWAVE_RT {
    return std::span<const double>(volts_[channel]).first(n_);
  }

 private:
  struct Route {
    std::size_t patch = 0, output = 0, channel = 0;
  };
  struct Gate {
    std::size_t patch = 0, event = 0, channel = 0;
    double volts = 0;
    bool is_open = false;
  };
  using Row = std::array<double, kMostSamples>;
  void fill_gates(std::size_t patch, std::size_t end) KNOTWAVE_RT;

  std::vector<Route> routes_;
  std::vector<Gate> gates_;
  bool has_gates_ = false;
  std::vector<Row> volts_, gate_volts_;  ///< [channel]
  std::vector<std::size_t> done_;        ///< [patch] samples that have their gates
  std::int64_t first_ = 0;
  std::size_t n_ = 0;
};

}  // namespace knotwave::engine
