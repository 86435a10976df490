// SPDX-License-Identifier: MIT
// A MIDI file that the synth plays by itself, every event at its sample: as knotwave-render would.
#pragma once
#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "knotwave/engine/event.h"
#include "knotwave/io/midi_file.h"

#include "port_notes.h"

namespace knotwave::synth {

class SongPlayer {
 public:
  static constexpr std::size_t kMostEvents = 4096;  ///< of one due(); more come with the next

  explicit SongPlayer(io::Song song);

  /// The next sample that due() is asked about is `position_s` into the song, of an engine that
  /// knows what the song held down until then. [control, stopped]
  void begin(double rate_hz, double position_s);
  /// What is due in the next `frames` samples; times are offsets in these. At the song's end its
  /// own notes and pedals are let go, and nobody else's. Valid until the next call. [audio]
  std::span<const engine::Event> due(int frames) KNOTWAVE_RT;
  /// The song is over, and lets go what it holds with the next block. [any]
  void stop() KNOTWAVE_RT { is_stopped_.store(true, std::memory_order_relaxed); }

  // [any]
  bool is_over() const KNOTWAVE_RT { return is_over_.load(std::memory_order_relaxed); }
  double position_s() const KNOTWAVE_RT;  ///< length_s() at most
  double length_s() const { return length_s_; }

 private:
  void add(const engine::Event& event, std::int64_t from) KNOTWAVE_RT;
  void let_go(base::SampleTime offset) KNOTWAVE_RT;

  io::Song song_;
  std::vector<engine::Event> events_;  ///< times from the song's start
  base::SampleTime end_;
  double rate_hz_ = 48000, length_s_ = 0;
  std::atomic<std::int64_t> now_{0};  ///< samples since the song's start
  std::size_t next_ = 0;
  PortNotes held_;
  std::vector<engine::Event> due_;
  std::atomic<bool> is_stopped_{false}, is_over_{false};
};

}  // namespace knotwave::synth
