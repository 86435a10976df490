// SPDX-License-Identifier: MIT
// Clients of a JACK server that judge ours: one that captures sound, one that sends MIDI.
#pragma once
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include <jack/jack.h>

namespace knotwave::support {

/// Full names of the ports that a port is connected to.
std::vector<std::string> connections_of(const std::string& port);

/// Keeps every sample of its inputs, in memory given at the start.
class JackCapture {
 public:
  /// `sources`: full port names, one for each channel.
  JackCapture(const std::vector<std::string>& sources, std::size_t max_frames);
  /// A device called "capture" to which others connect.
  JackCapture(std::size_t channels, std::size_t max_frames);
  ~JackCapture();
  JackCapture(const JackCapture&) = delete;
  JackCapture& operator=(const JackCapture&) = delete;

  bool is_connected() const { return is_connected_; }
  std::size_t frames() const { return frames_.load(std::memory_order_acquire); }
  /// False after `timeout_s`.
  bool wait_for(std::size_t frames, double timeout_s) const;
  /// Of the first `frames()`.
  std::vector<float> channel(std::size_t channel) const;
  /// JACK's frame time of the first captured frame.
  jack_nframes_t first_frame_time() const { return first_frame_time_; }
  /// Faster than real time from here on, for the whole server.
  void set_freewheel(bool on);

 private:
  bool open(unsigned long flags);
  int process(jack_nframes_t frames);

  jack_client_t* client_ = nullptr;
  std::vector<jack_port_t*> ports_;
  std::vector<std::vector<float>> samples_;
  std::atomic<std::size_t> frames_{0};
  jack_nframes_t first_frame_time_ = 0;
  bool is_connected_ = false;
};

/// Sends messages at frames of JACK's own clock.
class JackMidiSender {
 public:
  struct Message {
    std::int64_t after = 0;  ///< frames after the first cycle that begins when all is connected
    std::vector<std::uint8_t> bytes;
  };
  enum class Connects { itself, by_others };
  /// In order of time. by_others: waits up to 10 s until somebody has connected it. Without a
  /// destination nothing is waited for.
  JackMidiSender(const std::string& destination, std::vector<Message> messages,
                 Connects connects = Connects::itself);
  ~JackMidiSender();
  JackMidiSender(const JackMidiSender&) = delete;
  JackMidiSender& operator=(const JackMidiSender&) = delete;

  bool is_connected() const { return is_connected_; }
  bool is_connected_to(const std::string& port) const;  ///< now
  void disconnect_from(const std::string& port);
  bool wait_until_sent(double timeout_s) const;
  /// JACK's frame time that `after` counts from.
  jack_nframes_t begin_frame_time() const { return begin_; }
  /// Messages the server had no room for.
  int refused() const { return refused_; }

 private:
  int process(jack_nframes_t frames);

  jack_client_t* client_ = nullptr;
  jack_port_t* port_ = nullptr;
  std::vector<Message> messages_;
  std::size_t next_ = 0;
  bool has_begun_ = false;
  jack_nframes_t begin_ = 0;
  std::atomic<bool> may_begin_{false}, is_sent_{false};
  std::atomic<int> refused_{0};
  bool is_connected_ = false;
};

}  // namespace knotwave::support
