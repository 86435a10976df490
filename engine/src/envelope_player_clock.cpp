// SPDX-License-Identifier: MIT
// Clock divisions, and where in the song they are.
#include <algorithm>

#include "envelope_player_state.h"

namespace knotwave::engine {

bool EnvelopePlayer::State::is_clocked() const KNOTWAVE_RT {
  return trigger.kind == TriggerSpec::Kind::clock && !is_by_hand && !is_stopped && !is_halted &&
         !waits_for_clock;
}

// Only the voice's own numbers decide, so that a copy of it can be led ahead.
void EnvelopePlayer::State::take_edge(const ClockGate::Edge& edge,
                                      EnvelopeVoice& voice) const KNOTWAVE_RT {
  if (!edge.opens) {
    voice.close(program, edge.time, 64);
    return;
  }
  const int channel = std::max(trigger.channel - 1, 0);
  if (!is_selected(channel)) return;
  const std::uint64_t number = voice.number() + 1;
  voice.open(program, context(channel, kGateKey, kGateVelocity, number), number, edge.time,
             config.rate_hz, tempo, true);
}

// Of edges at or before `time` those that no render() has come to.
void EnvelopePlayer::State::take_edges_until(base::SampleTime time) KNOTWAVE_RT {
  if (!is_clocked()) return;
  const std::int64_t sample = base::first_sample(time);
  for (ClockGate::Edge edge = clock.next(tempo); edge.time <= time; edge = clock.next(tempo)) {
    edge.time = std::max(edge.time, heard_at(edge.time));
    tell_places(edge.time);
    take_edge(edge, voices[0]);
    clock.pass(tempo, sample);
  }
}

// Samples first..first+n-1 of a voice that the clock plays, from edge to edge.
void EnvelopePlayer::State::advance_clocked(ClockGate& gate, EnvelopeVoice& voice,
                                            std::int64_t first, std::size_t n, std::size_t offset,
                                            bool is_real) KNOTWAVE_RT {
  std::size_t done = 0;
  while (done < n) {
    const std::int64_t here = first + static_cast<std::int64_t>(done);
    ClockGate::Edge edge = gate.next(tempo);
    const std::int64_t at = base::first_sample(edge.time);
    if (at <= here) {
      if (at < here) edge.time = {here, 0};
      if (is_real) tell_places(edge.time);
      take_edge(edge, voice);
      gate.pass(tempo, here);
      continue;
    }
    const auto left = static_cast<std::uint64_t>(at - here);
    const std::size_t count = std::min({n - done, kChunk, static_cast<std::size_t>(left)});
    render_voice(voice, here, count, rows(0, offset + done));
    done += count;
  }
}

void EnvelopePlayer::State::start_song(base::SampleTime time) KNOTWAVE_RT {
  const double since = last_clock < 0 ? config.rate_hz : base::samples_since(time, last_clock);
  place_song(0, time);
  is_stopped = is_halted = false;
  waits_for_clock = std::abs(since) < config.rate_hz;
  awaits_clock = true;
  follow_loop(time);
}

void EnvelopePlayer::State::continue_song(base::SampleTime time) KNOTWAVE_RT {
  if (!is_stopped && !is_halted) return;
  place_song(is_stopped ? stopped_at : tempo.beats_at(time), time);
  is_stopped = is_halted = false;
  follow_loop(time);
}

void EnvelopePlayer::State::stop_song(base::SampleTime time) KNOTWAVE_RT {
  if (!is_stopped) stopped_at = tempo.beats_at(time);
  is_stopped = true;
  awaits_clock = waits_for_clock = false;
  if (trigger.kind == TriggerSpec::Kind::clock && !is_by_hand) close(0, time, 64);
}

void EnvelopePlayer::State::place_song(double beats, base::SampleTime time) KNOTWAVE_RT {
  if (trigger.kind == TriggerSpec::Kind::clock && !is_by_hand) close(0, time, 64);
  stopped_at = beats;
  tempo.set_position(time, beats);
  clock.seek(beats);
}

void EnvelopePlayer::State::run_song(double beats, base::SampleTime time) KNOTWAVE_RT {
  constexpr double kOtherPlace = 1.0 / 96;
  if (!(std::abs(beats) <= kMostTarget)) return;
  const bool runs = !is_stopped && !is_halted && !waits_for_clock;
  if (runs && std::abs(beats - tempo.beats_at(time)) < kOtherPlace) {
    tempo.set_position(time, beats);
    return;
  }
  place_song(beats, time);
  is_stopped = is_halted = awaits_clock = waits_for_clock = false;
  follow_loop(time);
}

/// What a clock knows of the song better than the tempo did: an open gate stays open, and the next
/// opening comes where it belongs. From a quarter note on it is another place.
void EnvelopePlayer::State::mend_song(double beats, base::SampleTime time) KNOTWAVE_RT {
  constexpr double kOtherPlace = 1;
  if (std::abs(beats - tempo.beats_at(time)) >= kOtherPlace) return place_song(beats, time);
  tempo.set_position(time, beats);
}

// The first clock after Start is the song's beginning (MIDI 1.0). Where clocks came before Start it
// is waited for; where none did, the division began with Start, and does not begin again.
void EnvelopePlayer::State::hear_clock(base::SampleTime time) KNOTWAVE_RT {
  last_clock = time.sample;
  if (awaits_clock) tempo.set_position(time, 0);
  awaits_clock = waits_for_clock = false;
}

}  // namespace knotwave::engine
