// SPDX-License-Identifier: MIT
// Setting an envelope generator up, and what others see of it.
#include "knotwave/engine/envelope_generator.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"

#include "cable.h"
#include "generator_state.h"

namespace knotwave::engine {
namespace {

Result<std::unique_ptr<EnvelopePlayer>> make_player(const EnvelopeGeneratorConfig& config,
                                                    const EnvelopePatchProgram* patch,
                                                    std::size_t ahead) {
  EnvelopePlayerConfig player;
  player.rate_hz = config.rate_hz;
  player.seed = config.seed;
  player.most_ahead_samples = static_cast<int>(ahead);
  return EnvelopePlayer::create(player, patch);
}

Result<void> check(const EnvelopeGeneratorConfig& config) {
  const auto refuse = [](const std::string& what, double found, const std::string& range) {
    return fail(ErrorCode::value_out_of_range,
                what + " is " + base::number_text(found) + "; " + range + " are possible");
  };
  if (!(config.rate_hz >= 8000 && config.rate_hz <= 768000)) {
    return refuse("the rate of the clock", config.rate_hz, "8000 to 768000 samples a second");
  }
  if (!(config.lead_s >= 0 && config.lead_s <= 0.05)) {
    return refuse("lead_s", config.lead_s, "0 to 0.05 s");
  }
  if (!(config.bpm >= 1 && config.bpm <= 1000)) {
    return refuse("the tempo", config.bpm, "1 to 1000 quarter notes a minute");
  }
  return {};
}

std::uint32_t microseconds(double bpm) {
  return static_cast<std::uint32_t>(std::floor(6e7 / bpm + 0.5));
}

/// What an output at rest is on its cable.
int rest_step(const OutputSpec& spec) {
  const double step = std::floor(spec.rest + step_offset(spec.kind) + 0.5);
  return static_cast<int>(step);
}

}  // namespace

Result<std::unique_ptr<EnvelopeGenerator>> EnvelopeGenerator::create(
    const EnvelopeGeneratorConfig& config, std::span<const EnvelopePatchProgram* const> patches) {
  if (auto checked = check(config); !checked) return checked.error();
  auto state = std::make_unique<State>();
  state->config = config;
  state->patches.assign(patches.begin(), patches.end());
  state->volts = VoltageMix(patches);
  state->lead = static_cast<std::size_t>(std::floor(config.lead_s * config.rate_hz));
  std::vector<int> voices;
  for (const EnvelopePatchProgram* patch : patches) {
    auto player = make_player(config, patch, 0);
    if (!player) return player.error();
    voices.push_back((*player)->voices());
  }
  auto table = GeneratorRoutes::create(patches, voices);
  if (!table) return table.error();
  state->table = std::move(*table);
  if (auto made = state->set_up_lanes(); !made) return made.error();
  if (auto made = state->set_up_players(); !made) return made.error();
  state->set_up_rows();
  state->set_up_note_ports();
  state->clock.reset(config.rate_hz);
  state->events.resize(kMostEvents + kMostEndings);
  return std::unique_ptr<EnvelopeGenerator>(new EnvelopeGenerator(std::move(state)));
}

Result<void> EnvelopeGenerator::State::set_up_lanes() {
  for (const PortSpec& spec : table.ports) {
    OutputPortConfig port;
    port.wire = spec.wire;
    port.running_status = spec.running_status;
    port.rate_hz = config.rate_hz;
    auto made = OutputPort::create(port);
    if (!made) return made.error();
    ports.push_back(std::move(*made));
  }
  port_lanes.resize(ports.size());
  for (GeneratorLane& lane : table.lanes) {
    const OutputSpec& output = table.routes[static_cast<std::size_t>(lane.routes.front())].spec;
    LaneSpec spec;
    spec.kind = output.kind;
    spec.channel = std::max(output.channel, 1);
    spec.number = output.number;
    spec.bits = output.bits;
    spec.first_step = -1;
    spec.rest_step = rest_step(output);
    const auto port = static_cast<std::size_t>(lane.port);
    const auto added = ports[port]->add_lane(spec);
    if (!added) return added.error();
    lane.port_lane = *added;
    port_lanes[port].emplace_back();
  }
  std::size_t ahead = 0;
  for (const auto& port : ports) ahead = std::max(ahead, port->ahead_samples());
  predict = ahead - std::min(ahead, lead);
  return {};
}

Result<void> EnvelopeGenerator::State::set_up_players() {
  for (const EnvelopePatchProgram* patch : patches) {
    auto player = make_player(config, patch, predict);
    if (!player) return player.error();
    Event tempo;
    tempo.kind = Event::Kind::tempo;
    tempo.microseconds_per_quarter = microseconds(config.bpm);
    (*player)->handle(tempo);
    players.push_back(std::move(*player));
  }
  posted.assign(players.size(), 0);
  newest_note.assign(players.size(), 0);
  played.assign(players.size(), 0);
  return {};
}

void EnvelopeGenerator::State::set_up_rows() {
  rows.resize(table.lanes.size());
  addresses.resize(table.lanes.size());
  snapshots.resize(table.lanes.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const GeneratorLane& lane = table.lanes[i];
    const OutputSpec& spec = table.routes[static_cast<std::size_t>(lane.routes.front())].spec;
    rows[i].values.assign(lead + kBlock + predict, spec.rest + step_offset(spec.kind));
    rows[i].is_told = lane.voice < 0;
  }
  osc.resize(table.routes.size());
  for (std::size_t i = 0; i < osc.size(); ++i) {
    const double samples = config.rate_hz / std::max(table.routes[i].spec.osc_hz, 1e-3);
    osc[i].period = std::max<std::int64_t>(static_cast<std::int64_t>(std::ceil(samples)), 1);
  }
}

void EnvelopeGenerator::State::set_up_note_ports() {
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const EnvelopePatchSpec& spec = patches[p]->spec();
    const int patch = static_cast<int>(p);
    notes_ports.push_back(table.port(patch, spec, spec.notes_port));
    std::vector<int> places;
    for (const PlaceEventSpec& event : spec.place_events) {
      places.push_back(table.port(patch, spec, event.port));
    }
    place_ports.push_back(places);
    if (spec.notes != NoteOutput::off && notes_ports.back() == 0) notes_reach_first_port = true;
  }
}

EnvelopeGenerator::EnvelopeGenerator(std::unique_ptr<State> state) : state_(std::move(state)) {}
EnvelopeGenerator::~EnvelopeGenerator() = default;

const std::vector<PortSpec>& EnvelopeGenerator::ports() const { return state_->table.ports; }
std::size_t EnvelopeGenerator::voltage_channels() const { return state_->volts.channels(); }
std::int64_t EnvelopeGenerator::now() const KNOTWAVE_RT { return state_->now; }
std::int64_t EnvelopeGenerator::lost() const KNOTWAVE_RT { return state_->lost; }
MidiClockStatus EnvelopeGenerator::clock_status() const KNOTWAVE_RT {
  return state_->clock.status();
}
const PortCounters& EnvelopeGenerator::port_counters(int port) const KNOTWAVE_RT {
  return state_->ports[static_cast<std::size_t>(port)]->counters();
}

std::vector<RouteStatus> EnvelopeGenerator::routes() const {
  const State& s = *state_;
  std::vector<RouteStatus> all;
  for (std::size_t i = 0; i < s.table.routes.size(); ++i) {
    const GeneratorRoute& route = s.table.routes[i];
    RouteStatus status;
    status.patch = route.patch;
    status.output = route.output;
    status.port = route.port;
    status.value = s.osc[i].has_sent ? s.osc[i].sent : route.spec.rest;
    const EnvelopePlayer& player = *s.players[static_cast<std::size_t>(route.patch)];
    const int newest = player.newest_voice();
    if (route.spec.kind == OutputKind::voltage && newest >= 0) {
      const auto values = player.values(newest, route.output);
      if (values.size() > s.predict) status.value = values[values.size() - s.predict - 1];
    }
    std::int64_t bytes = 0;
    for (int k = 0; k < route.lanes; ++k) {
      const auto lane = static_cast<std::size_t>(route.first_lane) + static_cast<std::size_t>(k);
      const GeneratorLane& way = s.table.lanes[lane];
      const OutputPort& port = *s.ports[static_cast<std::size_t>(way.port)];
      const int step = port.last_step(way.port_lane);
      const bool is_shown = way.voice < 0 || way.voice == newest;
      if (is_shown && step >= 0) status.value = step - step_offset(route.spec.kind);
      bytes += port.lane_bytes(way.port_lane) - s.snapshots[lane][s.snapshot];
    }
    const std::int64_t elapsed = s.now - s.snapshot_times[s.snapshot];
    if (elapsed > 0) {
      status.bytes_per_second =
          static_cast<double>(bytes) * s.config.rate_hz / static_cast<double>(elapsed);
    }
    if (route.port >= 0) {
      const auto wire = s.table.ports[static_cast<std::size_t>(route.port)].wire;
      if (wire == PortSpec::Wire::din) status.share = status.bytes_per_second / kDinBytesPerSecond;
      if (wire == PortSpec::Wire::usb) {
        status.share = status.bytes_per_second / 3 * kUsbFrameSeconds / 16;
      }
    }
    all.push_back(status);
  }
  return all;
}

void EnvelopeGenerator::say_again(int port) KNOTWAVE_RT {
  state_->ports[static_cast<std::size_t>(port)]->say_again();
}
void EnvelopeGenerator::go_to_rest() KNOTWAVE_RT { state_->go_to_rest(); }
bool EnvelopeGenerator::is_at_rest() const KNOTWAVE_RT { return state_->is_at_rest(); }
bool EnvelopeGenerator::is_still() const KNOTWAVE_RT { return state_->is_still(); }
void EnvelopeGenerator::end_all() KNOTWAVE_RT { state_->end_all(); }

void EnvelopeGenerator::State::go_to_rest() KNOTWAVE_RT {
  if (is_resting) return;
  is_resting = true;
  rest_from = now;
  event_count = 0;
  for (std::size_t i = 0; i < players.size(); ++i) {
    players[i]->release_all();
    post_player_messages(static_cast<int>(i));
  }
  end_thru();
}

void EnvelopeGenerator::State::end_all() KNOTWAVE_RT {
  if (is_resting) return;
  event_count = 0;
  for (std::size_t i = 0; i < players.size(); ++i) {
    players[i]->end_all();
    post_player_messages(static_cast<int>(i));
  }
  for (LaneRow& row : rows) row.still = 0;
  end_thru();
}

void EnvelopeGenerator::State::end_thru() KNOTWAVE_RT {
  if (ports.empty()) return;
  base::MidiEvent event;
  event.time.sample = now;
  for (std::size_t key = 0; key < thru_keys.size(); ++key) {
    if (!thru_keys[key]) continue;
    event.bytes[0] = static_cast<std::uint8_t>(0x80 | key >> 7);
    event.bytes[1] = static_cast<std::uint8_t>(key & 127);
    event.bytes[2] = 64;
    ports[0]->post(event, OutputPriority::note, false);
  }
  for (std::size_t channel = 0; channel < thru_pedals.size(); ++channel) {
    if (!thru_pedals[channel]) continue;
    event.bytes[0] = static_cast<std::uint8_t>(0xB0 | channel);
    event.bytes[1] = 64;
    event.bytes[2] = 0;
    ports[0]->post(event, OutputPriority::note, false);
  }
  thru_keys.reset();
  thru_pedals.reset();
}

/// Every channel and key that a lane of voices ever spoke to comes to rest, one after another.
void EnvelopeGenerator::State::visit_told() KNOTWAVE_RT {
  if (!is_resting || now <= rest_from + static_cast<std::int64_t>(lead)) return;
  for (GeneratorRoute& route : table.routes) {
    if (!route.is_per_voice || route.told.none()) continue;
    const int rest = rest_step(route.spec);
    const GeneratorLane& first = table.lanes[static_cast<std::size_t>(route.first_lane)];
    OutputPort& port = *ports[static_cast<std::size_t>(first.port)];
    bool is_done = true;
    for (int k = 0; k < route.lanes; ++k) {
      const auto index = static_cast<std::size_t>(route.first_lane) + static_cast<std::size_t>(k);
      if (!rows[index].is_told) continue;
      if (port.last_step(table.lanes[index].port_lane) == rest) {
        route.told[addresses[index].place()] = false;
      } else {
        is_done = false;
      }
    }
    if (!is_done || route.told.none()) continue;
    std::size_t next = 0;
    while (!route.told[next]) ++next;
    set_address(static_cast<std::size_t>(route.first_lane), LaneAddress::at(next),
                now - static_cast<std::int64_t>(lead));
  }
}

bool EnvelopeGenerator::State::is_at_rest() const KNOTWAVE_RT {
  if (!is_resting || now <= rest_from + static_cast<std::int64_t>(lead)) return false;
  for (const auto& port : ports) {
    if (port->is_waiting()) return false;
  }
  for (const GeneratorRoute& route : table.routes) {
    if (route.told.any()) return false;
  }
  for (std::size_t i = 0; i < table.lanes.size(); ++i) {
    const GeneratorLane& lane = table.lanes[i];
    if (!rows[i].is_told) continue;
    const OutputSpec& spec = table.routes[static_cast<std::size_t>(lane.routes.front())].spec;
    const int step = ports[static_cast<std::size_t>(lane.port)]->last_step(lane.port_lane);
    if (step != rest_step(spec)) return false;
  }
  return true;
}

bool EnvelopeGenerator::State::is_still() const KNOTWAVE_RT {
  if (event_count != 0 || (is_resting && !is_at_rest())) return false;
  for (const auto& player : players) {
    if (!player->is_still()) return false;
  }
  for (const auto& port : ports) {
    if (port->is_waiting()) return false;
  }
  for (const LaneRow& row : rows) {
    if (row.is_told && !holds(row)) return false;
  }
  for (std::size_t i = 0; i < osc.size(); ++i) {
    if (table.routes[i].spec.kind == OutputKind::osc && !osc[i].is_settled) return false;
  }
  return true;
}

}  // namespace knotwave::engine
