// SPDX-License-Identifier: MIT
#include "jack_graph.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include <jack/midiport.h>

#include "complete_midi.h"
#include "jack_cycle.h"

namespace knotwave::io {
namespace {

// The largest MIDI buffer of jackd 1.9.21 is 32 KiB and an event takes 12 bytes of it or more:
// 2730.
constexpr std::size_t kMaxMidiEvents = 4096;

}  // namespace

JackGraph::JackGraph(JackClient client, AudioClient& audio, int channels)
    : pump_(audio, jack_get_sample_rate(client.get()), channels),
      outputs_(static_cast<std::size_t>(channels)),
      buffers_(static_cast<std::size_t>(channels)),
      events_(kMaxMidiEvents),
      client_(std::move(client)) {
  news_.block_frames = static_cast<int>(jack_get_buffer_size(client_.get()));
  news_.rate_hz = static_cast<int>(jack_get_sample_rate(client_.get()));
}

Result<void> JackGraph::enter() {
  for (std::size_t c = 0; c < outputs_.size(); ++c) {
    outputs_[c] = jack_port_register(client(), ("out_" + std::to_string(c + 1)).c_str(),
                                     JACK_DEFAULT_AUDIO_TYPE, JackPortIsOutput, 0);
  }
  midi_ = jack_port_register(client(), "midi_in", JACK_DEFAULT_MIDI_TYPE, JackPortIsInput, 0);
  if (midi_ == nullptr || std::count(outputs_.begin(), outputs_.end(), nullptr) > 0) {
    return fail(ErrorCode::io_failed, "the JACK server has no ports left for us");
  }
  set_callbacks();
  return {};
}

void JackGraph::set_callbacks() {
  jack_set_process_callback(
      client(),
      [](jack_nframes_t frames, void* us) { return static_cast<JackGraph*>(us)->process(frames); },
      this);
  jack_on_info_shutdown(
      client(),
      [](jack_status_t /*code*/, const char* reason, void* us) {
        News& news = static_cast<JackGraph*>(us)->news_;
        if (reason != nullptr) std::strncpy(news.reason.data(), reason, news.reason.size() - 1);
        JackTicket::server_has_gone();
        news.is_over = true;
      },
      this);
  set_news_callbacks();
}

void JackGraph::set_news_callbacks() {
  jack_set_xrun_callback(
      client(),
      [](void* us) {
        static_cast<JackGraph*>(us)->news_.xruns.fetch_add(1, std::memory_order_relaxed);
        return 0;
      },
      this);
  jack_set_port_registration_callback(
      client(),
      [](jack_port_id_t port, int comes, void* us) {
        if (comes != 0) static_cast<JackGraph*>(us)->note_port(port);
      },
      this);
  jack_set_buffer_size_callback(
      client(),
      [](jack_nframes_t frames, void* us) {
        static_cast<JackGraph*>(us)->news_.block_frames = static_cast<int>(frames);
        return 0;
      },
      this);
  jack_set_sample_rate_callback(
      client(),
      [](jack_nframes_t rate_hz, void* us) {
        static_cast<JackGraph*>(us)->news_.rate_hz = static_cast<int>(rate_hz);
        return 0;
      },
      this);
  jack_set_freewheel_callback(
      client(),
      [](int starts, void* us) {
        static_cast<JackGraph*>(us)->news_.is_freewheeling = starts != 0;
      },
      this);
}

/// On JACK's own thread for news.
void JackGraph::note_port(jack_port_id_t port) {
  const jack_port_t* const found = jack_port_by_id(client(), port);
  const char* const name = found == nullptr ? nullptr : jack_port_name(found);
  if (name == nullptr) return;
  const std::lock_guard lock(mutex_);
  ports_that_came_.emplace(name);
}

std::set<std::string> JackGraph::take_ports_that_came() {
  const std::lock_guard lock(mutex_);
  return std::exchange(ports_that_came_, {});
}

int JackGraph::process(jack_nframes_t frames) KNOTWAVE_RT {
  for (std::size_t c = 0; c < outputs_.size(); ++c) {
    buffers_[c] = static_cast<float*>(jack_port_get_buffer(outputs_[c], frames));
  }
  follow_cycle(client(), frames, clock_);
  const std::size_t events = read_midi(frames);
  pump_.run({.frame = clock_.frame(),
             .time_ns = clock_.time_ns(),
             .outputs = buffers_,
             .frames = static_cast<int>(frames),
             .midi = std::span(events_).first(events),
             .has_deadline = !news_.is_freewheeling.load(std::memory_order_relaxed)});
  return 0;
}

std::size_t JackGraph::read_midi(jack_nframes_t frames) KNOTWAVE_RT {
  void* const buffer = jack_port_get_buffer(midi_, frames);
  const jack_nframes_t count = jack_midi_get_event_count(buffer);
  std::size_t kept = 0;
  std::int64_t dropped = jack_midi_get_lost_event_count(buffer);
  for (jack_nframes_t i = 0; i < count; ++i) {
    jack_midi_event_t message;
    const bool is_read = kept < events_.size() && jack_midi_event_get(&message, buffer, i) == 0 &&
                         read_complete_midi({message.buffer, message.size}, events_[kept]);
    if (!is_read) {
      ++dropped;
      continue;
    }
    events_[kept++].time = {std::min(message.time, frames - 1), 0};
  }
  if (dropped > 0) news_.midi_dropped.fetch_add(dropped, std::memory_order_relaxed);
  return kept;
}

}  // namespace knotwave::io
