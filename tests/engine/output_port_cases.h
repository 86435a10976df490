// SPDX-License-Identifier: MIT
// A port driven by functions of time, and what a receiver on its cable holds.
#pragma once
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "knotwave/engine/output_port.h"

namespace knotwave::engine::test {

struct Sent {
  base::MidiEvent event;
  double begin_s = 0, arrival_s = 0;
  int bytes = 0;
};

/// Writes down what goes over the cable, with the bytes that MIDI 1.0 makes of it.
class Wire final : public PortSink {
 public:
  explicit Wire(const OutputPortConfig& config) : config_(config) {}
  void send(const base::MidiEvent& event) KNOTWAVE_RT override {
    const std::uint8_t status = event.bytes[0];
    int bytes = 3;
    if (status >= 0xF0) {
      bytes = status >= 0xF8 ? 1 : static_cast<int>(event.sysex_size) + 2;
      if (status < 0xF8) running_ = 0;
    } else {
      if ((status & 0xE0) == 0xC0) bytes = 2;
      if (config_.running_status && config_.wire == PortSpec::Wire::din && status == running_) {
        --bytes;
      }
      running_ = status;
    }
    const double begin = (static_cast<double>(event.time.sample) +
                          static_cast<double>(event.time.fraction) * 0x1p-32) /
                         config_.rate_hz;
    const double takes = config_.wire == PortSpec::Wire::din ? bytes / kDinBytesPerSecond : 0;
    sent.push_back({event, begin, begin + takes, bytes});
  }
  std::vector<Sent> sent;

 private:
  OutputPortConfig config_;
  std::uint8_t running_ = 0;
};

/// Steps over time in seconds; the second argument is the time up to which the future is known.
using Motion = std::function<double(double, double)>;

/// Renders samples first..first+n-1 in blocks that never cross a sample of `events`.
inline void play(
    OutputPort& port, Wire& wire, const std::vector<Motion>& motions, std::int64_t first,
    std::int64_t end, double rate_hz, const std::vector<std::int64_t>& events = {},
    const std::function<std::int64_t()>& block = [] { return std::int64_t{64}; }) {
  std::vector<std::vector<double>> values(motions.size());
  std::vector<OutputPort::LaneValues> spans(motions.size());
  while (first < end) {
    std::int64_t n = std::min(block(), end - first);
    for (const std::int64_t event : events) {
      if (event > first && event < first + n) n = event - first;
    }
    const std::size_t count = static_cast<std::size_t>(n) + port.ahead_samples();
    const double known = static_cast<double>(first + n - 1) / rate_hz;
    for (std::size_t lane = 0; lane < motions.size(); ++lane) {
      values[lane].resize(count);
      for (std::size_t i = 0; i < count; ++i) {
        const double t = static_cast<double>(first + static_cast<std::int64_t>(i)) / rate_hz;
        values[lane][i] = motions[lane](t, known);
      }
      spans[lane] = values[lane];
    }
    port.render(first, static_cast<std::size_t>(n), spans, wire);
    first += n;
  }
}

/// What a receiver makes of a lane's messages, in steps: (time, value) in order. Upper halves reset
/// the lower ones as MIDI 1.0 says; a value counts when its last half has come.
struct Held {
  double time_s = 0;
  int step = 0;
};

}  // namespace knotwave::engine::test
