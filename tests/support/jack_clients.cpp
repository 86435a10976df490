// SPDX-License-Identifier: MIT
#include "support/jack_clients.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <functional>
#include <thread>

#include <jack/midiport.h>

namespace knotwave::support {
namespace {

bool wait_until(const std::function<bool()>& is_so, double timeout_s) {
  const auto begin = std::chrono::steady_clock::now();
  while (!is_so()) {
    if (std::chrono::steady_clock::now() - begin > std::chrono::duration<double>(timeout_s)) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace

std::vector<std::string> connections_of(const std::string& port) {
  std::vector<std::string> found;
  jack_client_t* const client = jack_client_open("look", JackNoStartServer, nullptr);
  if (client == nullptr) return found;
  const char** const names =
      jack_port_get_all_connections(client, jack_port_by_name(client, port.c_str()));
  for (const char* const* name = names; name != nullptr && *name != nullptr; ++name) {
    found.emplace_back(*name);
  }
  jack_free(names);
  jack_client_close(client);
  return found;
}

JackCapture::JackCapture(const std::vector<std::string>& sources, std::size_t max_frames)
    : samples_(sources.size(), std::vector<float>(max_frames)) {
  if (!open(JackPortIsInput)) return;
  is_connected_ = true;
  for (std::size_t c = 0; c < sources.size(); ++c) {
    is_connected_ &= jack_connect(client_, sources[c].c_str(), jack_port_name(ports_[c])) == 0;
  }
}

JackCapture::JackCapture(std::size_t channels, std::size_t max_frames)
    : samples_(channels, std::vector<float>(max_frames)) {
  open(JackPortIsInput | JackPortIsPhysical);
}

bool JackCapture::open(unsigned long flags) {
  client_ = jack_client_open("capture", JackNoStartServer, nullptr);
  if (client_ == nullptr) return false;
  for (std::size_t c = 0; c < samples_.size(); ++c) {
    ports_.push_back(jack_port_register(client_, ("in_" + std::to_string(c + 1)).c_str(),
                                        JACK_DEFAULT_AUDIO_TYPE, flags, 0));
  }
  jack_set_process_callback(
      client_, [](jack_nframes_t n, void* us) { return static_cast<JackCapture*>(us)->process(n); },
      this);
  return jack_activate(client_) == 0;
}

JackCapture::~JackCapture() {
  if (client_ != nullptr) jack_client_close(client_);
}

int JackCapture::process(jack_nframes_t frames) {
  const std::size_t begin = frames_.load(std::memory_order_relaxed);
  if (begin == 0) first_frame_time_ = jack_last_frame_time(client_);
  const std::size_t count = std::min<std::size_t>(frames, samples_.front().size() - begin);
  for (std::size_t c = 0; c < ports_.size(); ++c) {
    const auto* const in = static_cast<const float*>(jack_port_get_buffer(ports_[c], frames));
    std::copy_n(in, count, samples_[c].begin() + static_cast<std::ptrdiff_t>(begin));
  }
  frames_.store(begin + count, std::memory_order_release);
  return 0;
}

bool JackCapture::wait_for(std::size_t frames, double timeout_s) const {
  return wait_until([&] { return this->frames() >= frames; }, timeout_s);
}

std::vector<float> JackCapture::channel(std::size_t channel) const {
  const auto begin = samples_[channel].begin();
  return {begin, begin + static_cast<std::ptrdiff_t>(frames())};
}

void JackCapture::set_freewheel(bool on) { jack_set_freewheel(client_, on ? 1 : 0); }

JackMidiSender::JackMidiSender(const std::string& destination, std::vector<Message> messages,
                               Connects connects)
    : messages_(std::move(messages)) {
  client_ = jack_client_open("sender", JackNoStartServer, nullptr);
  if (client_ == nullptr) return;
  port_ = jack_port_register(client_, "out", JACK_DEFAULT_MIDI_TYPE, JackPortIsOutput, 0);
  jack_set_process_callback(
      client_,
      [](jack_nframes_t n, void* us) { return static_cast<JackMidiSender*>(us)->process(n); },
      this);
  if (jack_activate(client_) != 0) return;
  if (connects == Connects::by_others) {
    is_connected_ = wait_until([&] { return is_connected_to(destination); }, 10);
  } else if (!destination.empty()) {
    const int fault = jack_connect(client_, jack_port_name(port_), destination.c_str());
    is_connected_ = fault == 0 || fault == EEXIST;  // somebody else may have been quicker
  }
  may_begin_ = true;
}

JackMidiSender::~JackMidiSender() {
  if (client_ != nullptr) jack_client_close(client_);
}

int JackMidiSender::process(jack_nframes_t frames) {
  void* const buffer = jack_port_get_buffer(port_, frames);
  jack_midi_clear_buffer(buffer);
  if (!may_begin_) return 0;
  const jack_nframes_t now = jack_last_frame_time(client_);
  if (!has_begun_) begin_ = now;
  has_begun_ = true;
  for (; next_ < messages_.size(); ++next_) {
    const Message& message = messages_[next_];
    const std::int64_t offset = message.after - static_cast<std::int64_t>(now - begin_);
    if (offset >= frames) return 0;
    const auto at = static_cast<jack_nframes_t>(std::max<std::int64_t>(offset, 0));
    const int fault = jack_midi_event_write(buffer, at, message.bytes.data(), message.bytes.size());
    if (fault != 0) ++refused_;
  }
  is_sent_ = true;
  return 0;
}

bool JackMidiSender::is_connected_to(const std::string& port) const {
  return jack_port_connected_to(port_, port.c_str()) != 0;
}

void JackMidiSender::disconnect_from(const std::string& port) {
  jack_disconnect(client_, jack_port_name(port_), port.c_str());
}

bool JackMidiSender::wait_until_sent(double timeout_s) const {
  return wait_until([&] { return is_sent_.load(); }, timeout_s);
}

}  // namespace knotwave::support
