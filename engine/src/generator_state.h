// SPDX-License-Identifier: MIT
// The envelope generator's insides. Players run `lead` samples ahead of the cables, so that what a
// cable must begin early is known.
#pragma once
#include <array>
#include <bitset>
#include <memory>
#include <vector>

#include "knotwave/engine/envelope_generator.h"
#include "knotwave/engine/event.h"
#include "knotwave/engine/midi_clock.h"
#include "knotwave/engine/voltage_mix.h"

#include "generator_routes.h"

namespace knotwave::engine {

/// What a lane did lately and what it will do: [lead | a block | what is predicted].
struct LaneRow {
  std::vector<double> values;
  std::int64_t still = 0;  ///< samples since it moved
  bool is_told = false;    ///< it has an address
};

/// What a lane of a voice is about.
struct LaneAddress {
  int channel = 0;  ///< 0: nothing yet
  int key = 0;
  std::size_t place() const KNOTWAVE_RT {
    return 128 * static_cast<std::size_t>(channel - 1) + static_cast<std::size_t>(key);
  }
  static LaneAddress at(std::size_t place) KNOTWAVE_RT {
    return {static_cast<int>(place / 128) + 1, static_cast<int>(place % 128)};
  }
  friend bool operator==(const LaneAddress&, const LaneAddress&) = default;
};

struct OscState {
  double sent = 0;
  bool has_sent = false;
  bool is_settled = false;  ///< it has sent what it is
  std::int64_t next = 0, period = 1;
};

struct EnvelopeGenerator::State {
  static constexpr std::size_t kBlock = EnvelopePlayer::kMostSamples;
  static constexpr std::size_t kSnapshots = 9;  ///< of bytes, eight a second

  // Set up.
  Result<void> set_up_lanes();
  Result<void> set_up_players();
  void set_up_rows();
  void set_up_note_ports();
  // The clock.
  bool push(const Event& event) KNOTWAVE_RT;
  void take_events() KNOTWAVE_RT;
  void take_event(const Event& event) KNOTWAVE_RT;
  std::size_t block_length(std::int64_t until) const KNOTWAVE_RT;
  void play_block(std::size_t n, GeneratorSink& sink) KNOTWAVE_RT;
  // From players to rows.
  void note_addresses() KNOTWAVE_RT;
  void set_address(std::size_t lane, LaneAddress address, std::int64_t from) KNOTWAVE_RT;
  void leave_address(const GeneratorRoute& route, std::size_t lane) KNOTWAVE_RT;
  void note_newest(const Event& event) KNOTWAVE_RT;
  int source_route(const GeneratorLane& lane) const KNOTWAVE_RT;
  void fill_rows(std::size_t n) KNOTWAVE_RT;
  void fill_row(std::size_t lane, std::size_t n) KNOTWAVE_RT;
  void send_osc(std::size_t n, GeneratorSink& sink) KNOTWAVE_RT;
  void send_volts(GeneratorSink& sink) KNOTWAVE_RT;
  // To the cables.
  void post_player_messages(int patch) KNOTWAVE_RT;
  void post_thru(const base::MidiEvent& event) KNOTWAVE_RT;
  void post_player_message(int patch, const PlayerMessage& message) KNOTWAVE_RT;
  void render_ports_and_messages(std::size_t n, GeneratorSink& sink) KNOTWAVE_RT;
  void render_ports(std::size_t from, std::size_t n, GeneratorSink& sink) KNOTWAVE_RT;
  void take_snapshot() KNOTWAVE_RT;
  // Rest.
  void go_to_rest() KNOTWAVE_RT;
  void end_thru() KNOTWAVE_RT;
  void end_all() KNOTWAVE_RT;
  void visit_told() KNOTWAVE_RT;
  bool is_at_rest() const KNOTWAVE_RT;
  bool is_still() const KNOTWAVE_RT;
  bool holds(const LaneRow& row) const KNOTWAVE_RT;

  EnvelopeGeneratorConfig config;
  std::vector<const EnvelopePatchProgram*> patches;
  std::vector<std::unique_ptr<EnvelopePlayer>> players;
  std::vector<std::unique_ptr<OutputPort>> ports;
  GeneratorRoutes table;
  std::vector<LaneRow> rows;                                    ///< of table.lanes
  std::vector<std::vector<OutputPort::LaneValues>> port_lanes;  ///< [port][lane of the port]
  std::vector<OscState> osc;                                    ///< of table.routes
  VoltageMix volts{{}};
  std::vector<LaneAddress> addresses;         ///< of table.lanes
  std::vector<int> notes_ports;               ///< of each patch
  std::vector<std::vector<int>> place_ports;  ///< [patch][place event]
  bool notes_reach_first_port = false;        ///< a patch passes them there: thru leaves them out
  std::size_t lead = 0;                       ///< of the players before the cables
  std::size_t predict = 0;                    ///< beyond the players' last sample
  std::int64_t now = 0;

  std::vector<Event> events;  ///< a ring
  std::size_t first_event = 0, event_count = 0;
  std::int64_t lost = 0;

  MidiClock clock;
  std::vector<std::size_t> posted;         ///< of each patch's messages of this block
  std::vector<std::uint64_t> newest_note;  ///< of each patch
  std::vector<std::uint64_t> played;       ///< counts up with each patch's new notes
  std::uint64_t notes_played = 0;
  std::bitset<kKeysOfAllChannels> thru_keys;
  std::bitset<16> thru_pedals;
  bool is_resting = false;
  std::int64_t rest_from = 0;

  std::vector<std::array<std::int64_t, kSnapshots>> snapshots;  ///< of table.lanes
  std::array<std::int64_t, kSnapshots> snapshot_times{};
  std::int64_t next_snapshot = 0;
  std::size_t snapshot = 0;  ///< the oldest
};

}  // namespace knotwave::engine
