// SPDX-License-Identifier: MIT
// A MIDI cable: how long a message takes, when it is free again, what went over it. All [audio]
// but the constructor.
#pragma once
#include <array>
#include <cstdint>

#include "knotwave/engine/output_port.h"

#include "lane_curve.h"

namespace knotwave::engine {

/// Bytes of a message with its status byte.
std::int64_t message_bytes(const base::MidiEvent& event) KNOTWAVE_RT;

/// Note off, all sound off, all notes off: never left out while anything else is there.
bool ends_notes(const base::MidiEvent& event) KNOTWAVE_RT;

class Cable {
 public:
  explicit Cable(const OutputPortConfig& config);

  bool is_din() const KNOTWAVE_RT { return config_.wire == PortSpec::Wire::din; }
  Ticks free_at() const KNOTWAVE_RT { return free_at_; }
  /// What bytes take: 0 but on DIN.
  Ticks time_of_bytes(std::int64_t bytes) const KNOTWAVE_RT { return bytes * byte_ticks_; }
  /// From one message of a lane to its next at least, whatever they cost: a USB frame, a sample.
  Ticks spacing() const KNOTWAVE_RT { return spacing_; }
  bool has_running_status() const KNOTWAVE_RT { return is_din() && config_.running_status; }
  /// The status that need not be sent again, 0: none.
  std::uint8_t running() const KNOTWAVE_RT { return running_; }
  /// Bytes on the wire if sent now.
  std::int64_t bytes_now(const base::MidiEvent& event) const KNOTWAVE_RT;

  /// Puts a message on the wire at `begin` >= free_at(); its bytes there.
  std::int64_t send(const base::MidiEvent& event, Ticks begin, bool is_thru) KNOTWAVE_RT;
  /// A message came to be passed through while `waiting_bytes` of such waited.
  void count_arrival(std::int64_t bytes, std::int64_t waiting_bytes) KNOTWAVE_RT;
  void count_wait(Ticks waited) KNOTWAVE_RT;
  void count_loss() KNOTWAVE_RT { ++counters_.lost; }
  void update_use(Ticks now) KNOTWAVE_RT;
  const PortCounters& counters() const KNOTWAVE_RT { return counters_; }

 private:
  static constexpr std::size_t kPacketEvents = 16;  ///< of 4 bytes in a packet of 64
  static constexpr int kUseParts = 50;

  void occupy_packets(std::int64_t bytes, Ticks begin) KNOTWAVE_RT;
  void count_use(std::int64_t load, Ticks begin) KNOTWAVE_RT;
  std::int64_t load(std::int64_t bytes) const KNOTWAVE_RT;  ///< bytes, or USB events

  OutputPortConfig config_;
  Ticks byte_ticks_ = 0, frame_ticks_ = 0, spacing_ = 0, part_ticks_ = 1;
  Ticks free_at_ = 0;
  std::uint8_t running_ = 0;
  std::array<Ticks, kPacketEvents> packet_{};  ///< when the last 16 events went
  std::size_t oldest_ = 0;
  std::array<std::int64_t, kUseParts> use_{};
  std::int64_t use_part_ = 0, use_sum_ = 0;
  PortCounters counters_;
};

}  // namespace knotwave::engine
