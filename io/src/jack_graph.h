// SPDX-License-Identifier: MIT
// Our client in JACK's graph: its ports and its callbacks. jack_stream.cpp is the control side.
#pragma once
#include <array>
#include <atomic>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include <jack/jack.h>

#include "block_pump.h"
#include "cycle_clock.h"
#include "jack_devices.h"

namespace knotwave::io {

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
  /// Full names of the ports, of anybody, that came to the server since the last call. [control]
  std::set<std::string> take_ports_that_came();
  News& news() noexcept { return news_; }

 private:
  int process(jack_nframes_t frames) KNOTWAVE_RT;
  std::size_t read_midi(jack_nframes_t frames) KNOTWAVE_RT;
  void set_callbacks();
  void set_news_callbacks();
  void note_port(jack_port_id_t port);

  News news_;
  std::mutex mutex_;
  std::set<std::string> ports_that_came_;
  BlockPump pump_;
  CycleClock clock_;
  std::vector<jack_port_t*> outputs_;
  jack_port_t* midi_ = nullptr;
  std::vector<float*> buffers_;
  std::vector<base::MidiEvent> events_;
  JackClient client_;  ///< the last member: closed before what its callbacks use goes
};

}  // namespace knotwave::io
