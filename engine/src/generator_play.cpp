// SPDX-License-Identifier: MIT
// The envelope generator from sample to sample: events, players, rows, cables.
#include <algorithm>

#include "knotwave/base/fp_state.h"

#include "cable.h"
#include "generator_state.h"

namespace knotwave::engine {
namespace {

using base::MidiEvent;
using base::MidiStatus;

OutputPriority priority_of(const MidiEvent& event) KNOTWAVE_RT {
  if (event.bytes[0] >= 0xF8) return OutputPriority::clock;
  const bool is_note =
      event.status() == MidiStatus::note_on || event.status() == MidiStatus::note_off;
  return is_note ? OutputPriority::note : OutputPriority::control;
}

/// Hands on what a port sends, with the port's number.
class NumberedSink final : public PortSink {
 public:
  NumberedSink(GeneratorSink& sink, int port) : sink_(sink), port_(port) {}
  void send(const MidiEvent& event) KNOTWAVE_RT override { sink_.midi(port_, event); }

 private:
  GeneratorSink& sink_;
  int port_;
};

}  // namespace

bool EnvelopeGenerator::handle(const MidiEvent& event) KNOTWAVE_RT {
  Event told;
  told.midi = event;
  return state_->push(told);
}

bool EnvelopeGenerator::set_tempo(base::SampleTime time,
                                  std::uint32_t microseconds_per_quarter) KNOTWAVE_RT {
  Event told;
  told.kind = Event::Kind::tempo;
  told.midi.time = time;
  told.microseconds_per_quarter = microseconds_per_quarter;
  return state_->push(told);
}

bool EnvelopeGenerator::tell(const Event& event) KNOTWAVE_RT { return state_->push(event); }

bool EnvelopeGenerator::State::push(const Event& event) KNOTWAVE_RT {
  if (is_resting) return true;
  const bool is_ending = event.kind == Event::Kind::midi && ends_notes(event.midi);
  if (event_count >= (is_ending ? kMostEvents + kMostEndings : kMostEvents)) {
    ++lost;
    return false;
  }
  events[(first_event + event_count++) % events.size()] = event;
  return true;
}

void EnvelopeGenerator::advance(std::int64_t until, GeneratorSink& sink) KNOTWAVE_RT {
  const base::FpStateGuard guard;
  State& s = *state_;
  while (s.now < until) {
    s.take_events();
    s.play_block(s.block_length(until), sink);
  }
}

void EnvelopeGenerator::State::take_events() KNOTWAVE_RT {
  while (event_count != 0 && base::first_sample(events[first_event].time()) <= now) {
    const Event event = events[first_event];
    first_event = (first_event + 1) % events.size();
    --event_count;
    take_event(event);
  }
  note_addresses();
}

void EnvelopeGenerator::State::take_event(const Event& event) KNOTWAVE_RT {
  for (LaneRow& row : rows) row.still = 0;
  if (event.kind == Event::Kind::midi) {
    post_thru(event.midi);
    const MidiClock::News news = clock.handle(event.midi);
    for (auto& player : players) {
      if (news.tempo) player->handle(clock.tempo_event());
      if (news.position) player->handle(clock.position_event());
    }
  }
  for (std::size_t i = 0; i < players.size(); ++i) {
    players[i]->handle(event);
    post_player_messages(static_cast<int>(i));
  }
  note_addresses();
  note_newest(event);
}

std::size_t EnvelopeGenerator::State::block_length(std::int64_t until) const KNOTWAVE_RT {
  std::int64_t n = std::min<std::int64_t>(until - now, kBlock);
  if (event_count != 0) {
    n = std::min(n, base::first_sample(events[first_event].time()) - now);
  }
  return static_cast<std::size_t>(n);
}

void EnvelopeGenerator::State::play_block(std::size_t n, GeneratorSink& sink) KNOTWAVE_RT {
  volts.begin(now, n);
  for (std::size_t i = 0; i < players.size(); ++i) {
    EnvelopePlayer& player = *players[i];
    player.render(n);
    if (predict != 0) player.predict(predict);
  }
  fill_rows(n);
  send_osc(n, sink);
  render_ports_and_messages(n, sink);
  send_volts(sink);
  now += static_cast<std::int64_t>(n);
  for (LaneRow& row : rows) {
    std::copy_n(row.values.begin() + static_cast<std::ptrdiff_t>(n), lead, row.values.begin());
  }
  visit_told();
  if (now >= next_snapshot) take_snapshot();
}

/// Voices that were given another channel or key: their lanes follow, with their first value there
/// in time.
void EnvelopeGenerator::State::note_addresses() KNOTWAVE_RT {
  if (is_resting) return;
  for (std::size_t i = 0; i < table.lanes.size(); ++i) {
    const GeneratorLane& lane = table.lanes[i];
    if (lane.voice < 0) continue;
    GeneratorRoute& route = table.routes[static_cast<std::size_t>(lane.routes.front())];
    const auto patch = static_cast<std::size_t>(route.patch);
    const auto voice = players[patch]->voice(lane.voice);
    // What no key triggers has its channel from the start.
    const bool is_of_keys = patches[patch]->spec().trigger.kind == TriggerSpec::Kind::note;
    if (!voice.has_begun && is_of_keys) continue;
    LaneAddress address{voice.channel, voice.key};
    if (route.spec.channel != 0) address.channel = route.spec.channel;
    if (route.spec.kind != OutputKind::poly_pressure) address.key = 0;
    if (addresses[i] == address) continue;
    leave_address(route, i);
    route.told[address.place()] = true;
    set_address(i, address, now);
  }
}

/// A voice that stays where another one spoke to the last says its own value again.
void EnvelopeGenerator::State::leave_address(const GeneratorRoute& route,
                                             std::size_t lane) KNOTWAVE_RT {
  const auto first = static_cast<std::size_t>(route.first_lane);
  for (std::size_t i = first; i < first + static_cast<std::size_t>(route.lanes); ++i) {
    if (i == lane || !rows[i].is_told || addresses[i] != addresses[lane]) continue;
    rows[i].still = 0;
    const GeneratorLane& way = table.lanes[i];
    ports[static_cast<std::size_t>(way.port)]->say_again(way.port_lane);
  }
}

void EnvelopeGenerator::State::set_address(std::size_t lane, LaneAddress address,
                                           std::int64_t from) KNOTWAVE_RT {
  addresses[lane] = address;
  rows[lane].is_told = true;
  rows[lane].still = 0;  // the cable has not seen it
  const GeneratorLane& way = table.lanes[lane];
  ports[static_cast<std::size_t>(way.port)]->address(way.port_lane, address.channel, address.key,
                                                     from);
}

/// Which patch played last: by its keys, or, where it has none, by the program that chooses it.
void EnvelopeGenerator::State::note_newest(const Event& event) KNOTWAVE_RT {
  const MidiEvent& midi = event.midi;
  const bool is_program =
      event.kind == Event::Kind::midi && midi.status() == MidiStatus::program_change;
  for (std::size_t i = 0; i < players.size(); ++i) {
    const TriggerSpec& trigger = patches[i]->spec().trigger;
    if (trigger.kind != TriggerSpec::Kind::note) {
      const bool is_heard = trigger.channel == 0 || trigger.channel == midi.channel() + 1;
      if (is_program && is_heard && midi.bytes[1] == trigger.program) played[i] = ++notes_played;
      continue;
    }
    const int newest = players[i]->newest_voice();
    const std::uint64_t note = newest < 0 ? 0 : players[i]->voice(newest).note;
    if (note == newest_note[i]) continue;
    newest_note[i] = note;
    played[i] = ++notes_played;
  }
}

int EnvelopeGenerator::State::source_route(const GeneratorLane& lane) const KNOTWAVE_RT {
  int source = lane.routes.front();
  const auto when = [&](int route) {
    return played[static_cast<std::size_t>(table.routes[static_cast<std::size_t>(route)].patch)];
  };
  for (const int route : lane.routes) {
    if (when(route) > when(source)) source = route;
  }
  return source;
}

void EnvelopeGenerator::State::fill_rows(std::size_t n) KNOTWAVE_RT {
  for (std::size_t i = 0; i < rows.size(); ++i) fill_row(i, n);
}

void EnvelopeGenerator::State::fill_row(std::size_t lane, std::size_t n) KNOTWAVE_RT {
  const GeneratorLane& way = table.lanes[lane];
  LaneRow& row = rows[lane];
  const GeneratorRoute& route = table.routes[static_cast<std::size_t>(source_route(way))];
  const EnvelopePlayer& player = *players[static_cast<std::size_t>(route.patch)];
  // One that has not begun is at rest, but what is predicted of it may begin.
  const int voice = way.voice < 0 ? std::max(player.newest_voice(), 0) : way.voice;
  const double offset = step_offset(route.spec.kind);
  const auto to = row.values.begin() + static_cast<std::ptrdiff_t>(lead);
  const std::size_t count = n + predict;
  const double before = lead == 0 ? row.values[0] : *(to - 1);
  if (is_resting) {
    std::fill_n(to, count, route.spec.rest + offset);
  } else {
    const auto values = player.values(voice, route.output);
    for (std::size_t i = 0; i < count; ++i) {
      to[static_cast<std::ptrdiff_t>(i)] = values[std::min(i, values.size() - 1)] + offset;
    }
  }
  const auto end = to + static_cast<std::ptrdiff_t>(count);
  const bool holds = std::all_of(to, end, [before](double v) { return v == before; });
  row.still = holds && lead != 0 ? row.still + static_cast<std::int64_t>(n) : 0;
}

void EnvelopeGenerator::State::send_osc(std::size_t n, GeneratorSink& sink) KNOTWAVE_RT {
  for (std::size_t i = 0; i < osc.size(); ++i) {
    const GeneratorRoute& route = table.routes[i];
    if (route.spec.kind != OutputKind::osc) continue;
    const EnvelopePlayer& player = *players[static_cast<std::size_t>(route.patch)];
    const int voice = player.newest_voice();
    const bool is_playing = !is_resting && voice >= 0;
    OscState& state = osc[i];
    for (std::size_t k = 0; k < n; ++k) {
      const std::int64_t sample = now + static_cast<std::int64_t>(k);
      const double value = is_playing ? player.values(voice, route.output)[k] : route.spec.rest;
      state.is_settled = state.has_sent && value == state.sent;
      if (sample < state.next || state.is_settled) continue;
      state = {value, true, true, sample + state.period, state.period};
      sink.osc(route.patch, route.output, {sample, 0}, value);
    }
  }
}

void EnvelopeGenerator::State::send_volts(GeneratorSink& sink) KNOTWAVE_RT {
  if (volts.channels() == 0) return;
  volts.end([this](std::size_t patch, std::size_t output) KNOTWAVE_RT {
    const EnvelopePlayer& player = *players[patch];
    return player.values(std::max(player.newest_voice(), 0), static_cast<int>(output));
  });
  for (std::size_t c = 0; c < volts.channels(); ++c) {
    sink.volts(static_cast<int>(c), now, volts.volts(c));
  }
}

void EnvelopeGenerator::State::post_thru(const MidiEvent& event) KNOTWAVE_RT {
  if (!config.thru || ports.empty()) return;
  const bool is_on = event.status() == MidiStatus::note_on && event.bytes[2] != 0;
  const bool is_off = event.status() == MidiStatus::note_off ||
                      (event.status() == MidiStatus::note_on && event.bytes[2] == 0);
  if ((is_on || is_off) && notes_reach_first_port) return;
  const auto channel = static_cast<std::size_t>(event.channel());
  if (is_on || is_off) thru_keys[128 * channel + (event.bytes[1] & 127u)] = is_on;
  constexpr int kSustain = 64;
  if (event.status() == MidiStatus::control_change && event.bytes[1] == kSustain) {
    thru_pedals[channel] = event.bytes[2] >= 64;
  }
  ports[0]->post(event, priority_of(event), true);
}

void EnvelopeGenerator::State::post_player_messages(int patch) KNOTWAVE_RT {
  for (const PlayerMessage& message : players[static_cast<std::size_t>(patch)]->take_messages()) {
    post_player_message(patch, message);
  }
}

void EnvelopeGenerator::State::post_player_message(int patch,
                                                   const PlayerMessage& message) KNOTWAVE_RT {
  const auto p = static_cast<std::size_t>(patch);
  int port = notes_ports[p];
  if (message.kind == PlayerMessage::Kind::place_gate) {
    volts.hear(p, message);
    return;
  }
  if (message.kind == PlayerMessage::Kind::place_note) {
    port = place_ports[p][static_cast<std::size_t>(message.place_event)];
  }
  const bool passes =
      patches[p]->spec().notes == NoteOutput::thru && message.kind == PlayerMessage::Kind::thru;
  MidiEvent midi = message.midi;
  // Without a lead, cables have gone as far as the players: what came between the last two
  // samples goes out with the next, however blocks fall.
  if (lead == 0) midi.time = {base::first_sample(midi.time), 0};
  ports[static_cast<std::size_t>(port)]->post(midi, priority_of(midi), passes);
}

/// What players told in this block is posted where the cables have come as far, so that as much
/// waits then, and as much is left out of a full cable, however blocks fall.
void EnvelopeGenerator::State::render_ports_and_messages(std::size_t n,
                                                         GeneratorSink& sink) KNOTWAVE_RT {
  constexpr std::size_t kNone = ~std::size_t{0};
  std::fill(posted.begin(), posted.end(), 0);
  for (std::size_t done = 0;;) {
    std::size_t next = kNone, at = n;
    for (std::size_t i = 0; i < players.size() && !is_resting; ++i) {
      const auto messages = players[i]->take_messages();
      if (posted[i] == messages.size()) continue;
      const std::int64_t sample = base::first_sample(messages[posted[i]].midi.time) - now;
      const auto place = static_cast<std::size_t>(std::max<std::int64_t>(sample, 0));
      if (next == kNone || place < at) at = std::min(place, n), next = i;
    }
    if (at > done) render_ports(done, at - done, sink);
    done = std::max(done, at);
    if (next == kNone) return;
    post_player_message(static_cast<int>(next), players[next]->take_messages()[posted[next]++]);
  }
}

/// Long enough that the cable has seen all of what it holds.
bool EnvelopeGenerator::State::holds(const LaneRow& row) const KNOTWAVE_RT {
  return row.still > static_cast<std::int64_t>(2 * kBlock + lead);
}

void EnvelopeGenerator::State::render_ports(std::size_t from, std::size_t n,
                                            GeneratorSink& sink) KNOTWAVE_RT {
  const std::int64_t of_rows = now - static_cast<std::int64_t>(lead);
  const std::int64_t begin = of_rows + static_cast<std::int64_t>(from);
  const std::int64_t first = std::max<std::int64_t>(begin, 0);
  const std::int64_t end = begin + static_cast<std::int64_t>(n);
  if (first >= end) return;
  const auto count = static_cast<std::size_t>(end - first);
  const auto offset = static_cast<std::size_t>(first - of_rows);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const GeneratorLane& lane = table.lanes[i];
    const auto port = static_cast<std::size_t>(lane.port);
    auto& span = port_lanes[port][static_cast<std::size_t>(lane.port_lane)];
    span = {};
    if (!rows[i].is_told || holds(rows[i])) continue;
    span = std::span(rows[i].values).subspan(offset, count + ports[port]->ahead_samples());
  }
  for (std::size_t port = 0; port < ports.size(); ++port) {
    NumberedSink numbered(sink, static_cast<int>(port));
    ports[port]->render(first, count, port_lanes[port], numbered);
  }
}

void EnvelopeGenerator::State::take_snapshot() KNOTWAVE_RT {
  next_snapshot = now + static_cast<std::int64_t>(config.rate_hz / (kSnapshots - 1));
  for (std::size_t i = 0; i < table.lanes.size(); ++i) {
    const GeneratorLane& lane = table.lanes[i];
    snapshots[i][snapshot] = ports[static_cast<std::size_t>(lane.port)]->lane_bytes(lane.port_lane);
  }
  snapshot_times[snapshot] = now;
  snapshot = (snapshot + 1) % kSnapshots;
}

}  // namespace knotwave::engine
