// SPDX-License-Identifier: MIT
// Our client in JACK's graph: its ports and its callbacks. jack_stream.cpp is the control side.
#pragma once
#include <array>
#include <atomic>
#include <vector>

#include <jack/jack.h>

#include "block_pump.h"
#include "jack_devices.h"

namespace knotwave::io {

/// Where a block stands in time, from what JACK says of its cycle.
class JackClock {
 public:
  struct Cycle {
    jack_nframes_t frame_time = 0;  ///< at its begin; wraps
    std::int64_t age_us = 0;        ///< since its begin
    jack_nframes_t frames = 0;
  };
  /// The next cycle. Frames begin at 0, never overlap and jump over cycles that were skipped; times
  /// never go back. An age beyond a second, or before half a second from now, is taken as 0.
  /// [audio]
  void advance(const Cycle& cycle, std::int64_t now_ns) KNOTWAVE_RT;
  std::int64_t frame() const KNOTWAVE_RT { return frame_; }
  std::int64_t time_ns() const KNOTWAVE_RT { return time_ns_; }

 private:
  bool has_begun_ = false;
  jack_nframes_t last_ = 0, last_frames_ = 0;
  std::int64_t frame_ = 0, time_ns_ = 0;
};

/// The client's part in the graph; its address is what JACK calls back with.
class JackGraph {
 public:
  /// What JACK told, for any thread to read.
  struct News {
    std::atomic<std::int64_t> xruns{0}, midi_dropped{0};
    std::atomic<int> block_frames{0}, rate_hz{0};
    std::atomic<bool> is_freewheeling{false};
    std::atomic<bool> is_over{false};
    std::array<char, 200> reason{};  ///< written before is_over
  };

  JackGraph(JackClient client, AudioClient& audio, int channels);
  /// Ports and callbacks. Error: io_failed.
  Result<void> enter();

  jack_client_t* client() const noexcept { return client_.get(); }
  jack_port_t* output(std::size_t channel) const noexcept { return outputs_[channel]; }
  BlockPump& pump() noexcept { return pump_; }
  News& news() noexcept { return news_; }

 private:
  int process(jack_nframes_t frames) KNOTWAVE_RT;
  std::size_t read_midi(jack_nframes_t frames) KNOTWAVE_RT;
  void set_callbacks();
  void set_news_callbacks();

  News news_;
  BlockPump pump_;
  JackClock clock_;
  std::vector<jack_port_t*> outputs_;
  jack_port_t* midi_ = nullptr;
  std::vector<float*> buffers_;
  std::vector<base::MidiEvent> events_;
  JackClient client_;  ///< the last member: closed before what its callbacks use goes
};

}  // namespace knotwave::io
