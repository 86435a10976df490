// SPDX-License-Identifier: MIT
// A client of JACK that keeps every MIDI message with its frame.
#pragma once
#include <atomic>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <jack/jack.h>
#include <jack/midiport.h>

#include "knotwave/io/audio_device.h"

namespace knotwave::io {

/// A receiver that knows at which frame of JACK's each message came, and when each cycle began.
class JackReceiver {
 public:
  struct Heard {
    jack_nframes_t frame = 0;
    std::vector<int> bytes;
  };
  struct Cycle {
    jack_nframes_t frame = 0;
    double begin_ns = 0;  ///< by steady_clock_ns()
  };
  explicit JackReceiver(const char* name) {
    client_ = jack_client_open(name, JackNoStartServer, nullptr);
    if (client_ == nullptr) return;
    heard_.resize(20000);
    cycles_.resize(20000);
    port_ = jack_port_register(client_, "in", JACK_DEFAULT_MIDI_TYPE, JackPortIsInput, 0);
    jack_set_process_callback(
        client_,
        [](jack_nframes_t frames, void* us) {
          return static_cast<JackReceiver*>(us)->process(frames);
        },
        this);
    jack_activate(client_);
  }
  /// From a port of another client; false: there is none of that name, or not yet.
  bool connect(const std::string& source) {
    return jack_connect(client_, source.c_str(), jack_port_name(port_)) == 0;
  }
  /// MIDI outputs of clients whose names begin with `client`.
  std::vector<std::string> sources_of(const std::string& client) const {
    std::vector<std::string> all =
        taken(jack_get_ports(client_, nullptr, JACK_DEFAULT_MIDI_TYPE, JackPortIsOutput));
    std::erase_if(all, [&](const std::string& port) { return !port.starts_with(client); });
    return all;
  }
  /// Who hears a port of anybody.
  std::vector<std::string> connections_of(const std::string& port) const {
    jack_port_t* const found = jack_port_by_name(client_, port.c_str());
    if (found == nullptr) return {};
    return taken(jack_port_get_all_connections(client_, found));
  }
  /// The port of a client whose name begins with `client` that has `word` in its own.
  bool connect_to_client(const std::string& client, const std::string& word) {
    bool is_done = false;
    for (const std::string& port : sources_of(client)) {
      is_done |= port.find(word) != std::string::npos && connect(port);
    }
    return is_done;
  }
  ~JackReceiver() {
    if (client_ != nullptr) jack_client_close(client_);
  }
  JackReceiver(const JackReceiver&) = delete;
  JackReceiver& operator=(const JackReceiver&) = delete;

  std::size_t count() const { return heard_count_.load(); }
  const Heard& heard(std::size_t i) const { return heard_[i]; }
  /// JACK's frame at a time, by the two cycles around it; NaN where it has none.
  double frame_at(double time_ns) const {
    for (std::size_t i = 1; i < cycle_count_.load(); ++i) {
      const Cycle &a = cycles_[i - 1], &b = cycles_[i];
      if (time_ns < a.begin_ns || time_ns >= b.begin_ns) continue;
      return a.frame + (time_ns - a.begin_ns) / (b.begin_ns - a.begin_ns) * (b.frame - a.frame);
    }
    return std::nan("");
  }

 private:
  static std::vector<std::string> taken(const char** names) {
    std::vector<std::string> all;
    for (const char* const* name = names; name != nullptr && *name != nullptr; ++name) {
      all.emplace_back(*name);
    }
    jack_free(names);
    return all;
  }
  int process(jack_nframes_t frames) {
    jack_nframes_t frame = 0;
    jack_time_t begin_us = 0, next_us = 0;
    float period_us = 0;
    jack_get_cycle_times(client_, &frame, &begin_us, &next_us, &period_us);
    std::int64_t now_ns = 0;
    double age_us = 0;
    for (int i = 0; i < 20; ++i) {
      now_ns = steady_clock_ns();
      age_us = static_cast<double>(static_cast<std::int64_t>(jack_get_time() - begin_us));
      if (steady_clock_ns() - now_ns < 5000) break;
    }
    if (const std::size_t i = cycle_count_.load(); i < cycles_.size()) {
      cycles_[i] = {frame, static_cast<double>(now_ns) - age_us * 1000};
      cycle_count_.store(i + 1);
    }
    void* const buffer = jack_port_get_buffer(port_, frames);
    for (jack_nframes_t i = 0; i < jack_midi_get_event_count(buffer); ++i) {
      jack_midi_event_t event;
      jack_midi_event_get(&event, buffer, i);
      const std::size_t k = heard_count_.load();
      if (k == heard_.size()) break;
      heard_[k] = {frame + event.time, {event.buffer, event.buffer + event.size}};
      heard_count_.store(k + 1);
    }
    return 0;
  }

  jack_client_t* client_ = nullptr;
  jack_port_t* port_ = nullptr;
  std::vector<Heard> heard_;
  std::vector<Cycle> cycles_;
  std::atomic<std::size_t> heard_count_{0}, cycle_count_{0};
};

}  // namespace knotwave::io
