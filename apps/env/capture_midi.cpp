// SPDX-License-Identifier: MIT
// A knob's moves, from a MIDI file or elsewhere, as a recording.
#include <algorithm>

#include "knotwave/io/midi_file.h"

#include "capture.h"
#include "env_input.h"
#include "offline.h"

namespace knotwave::env {
namespace {

using engine::KnobRecorder;
using engine::MidiValueSpec;
using engine::OutputKind;

constexpr std::size_t kMostShown = 16;

double number_of(base::SampleTime time) {
  return static_cast<double>(time.sample) + static_cast<double>(time.fraction) * 0x1p-32;
}

std::string channels_text(unsigned channels) {
  std::string text;
  for (int channel = 1; channel <= 16; ++channel) {
    if ((channels >> channel & 1) == 0) continue;
    text += (text.empty() ? "" : ", ") + std::to_string(channel);
  }
  return text;
}

/// Beats on a clock that has as many samples in one of them as there are in a second.
base::SampleTime beat_time(std::uint64_t tick, int ticks_per_quarter) {
  const auto per_quarter = static_cast<std::uint64_t>(ticks_per_quarter);
  const unsigned __int128 samples = static_cast<unsigned __int128>(tick) * kClockHz;
  const auto whole = static_cast<std::uint64_t>(samples / per_quarter);
  const auto rest = static_cast<std::uint64_t>(samples % per_quarter);
  return {static_cast<std::int64_t>(std::min<std::uint64_t>(whole, std::uint64_t{1} << 62)),
          static_cast<std::uint32_t>((rest << 32) / per_quarter)};
}

/// Calls message(event), with its time in samples or such beats.
template <class Message>
base::SampleTime play_moves(const io::Song& song, bool in_beats, Message&& message) {
  io::TickClock clock(song, kClockHz);
  const auto time_of = [&](std::uint64_t tick) {
    return in_beats ? beat_time(tick, song.time_base.ticks_per_quarter) : clock.at(tick);
  };
  for (const io::SongEvent& event : song.events) {
    base::MidiEvent midi;
    midi.time = time_of(event.tick);
    std::copy_n(event.bytes, 3, midi.bytes);
    message(midi);
  }
  return time_of(song.length_ticks);
}

/// Seconds of the ramp as beats of the tempo that the song begins with.
double ramp_in_beats(double ramp_s, const io::Song& song) {
  const double per_quarter =
      song.tempos.empty() ? 500000 : song.tempos.front().microseconds_per_quarter;
  return ramp_s * 1e6 / per_quarter;
}

/// What is told within a microsecond is one value.
std::vector<engine::TimedStep> steps_of(const std::vector<engine::KnobMove>& moves,
                                        double samples_per_unit) {
  std::vector<engine::TimedStep> all;
  for (const engine::KnobMove& move : moves) {
    const double time = number_of(move.time) / samples_per_unit;
    const double last_told = number_of(move.last_told) / samples_per_unit;
    if (!all.empty() && !(time - all.back().time > 1e-6)) all.pop_back();
    if (!all.empty() && all.back().step == move.step) {
      all.back().last_told = last_told;
    } else {
      all.push_back({time, last_told, move.step});
    }
  }
  return all;
}

}  // namespace

void ValueList::hear(const base::MidiEvent& event) {
  MidiValueSpec spec;
  switch (event.status()) {
    case base::MidiStatus::control_change:
      if (event.bytes[1] > 119) return;
      spec.number = event.bytes[1];
      break;
    case base::MidiStatus::pitch_bend:
      spec = {OutputKind::pitch_bend, 0, 14};
      break;
    case base::MidiStatus::channel_pressure:
      spec.kind = OutputKind::channel_pressure;
      break;
    case base::MidiStatus::poly_pressure:
      spec.kind = OutputKind::poly_pressure;
      break;
    default:
      return;
  }
  const auto rank = [](const MidiValueSpec& s) { return std::pair(s.kind, s.number); };
  auto at = std::lower_bound(
      values_.begin(), values_.end(), spec,
      [&](const Value& value, const MidiValueSpec& s) { return rank(value.spec) < rank(s); });
  if (at == values_.end() || !(at->spec == spec)) at = values_.insert(at, {spec, 0});
  at->channels |= 1u << (event.channel() + 1);
}

std::string ValueList::text() const {
  if (values_.empty()) return "none";
  std::string text;
  for (std::size_t i = 0; i < values_.size() && i < kMostShown; ++i) {
    text += (text.empty() ? "" : ", ") + midi_value_text(values_[i].spec) + " (ch " +
            channels_text(values_[i].channels) + ")";
  }
  if (values_.size() > kMostShown) {
    text += " and " + std::to_string(values_.size() - kMostShown) + " more";
  }
  return text;
}

namespace {

constexpr int kHalf = 128;  ///< what 7 of 14 bits count in
constexpr std::size_t kLeastToTell = 4;

/// A wheel that knows 7 of its 14 bits: every value has a low half of 0, or at the upper stop both
/// are full.
bool is_coarse(const std::vector<engine::TimedStep>& steps, int last_step) {
  const auto has = [&](int step) {
    return std::any_of(steps.begin(), steps.end(), [=](const auto& s) { return s.step == step; });
  };
  if (last_step < kHalf || steps.size() < kLeastToTell) return false;
  if (has(last_step) && has(last_step - kHalf + 1)) return false;
  return std::all_of(steps.begin(), steps.end(), [=](const engine::TimedStep& s) {
    return s.step % kHalf == 0 || s.step == last_step;
  });
}

/// Between its own steps such a wheel is known as a knob of 7 bits is: the line is that of the
/// upper halves, each then what was told for it.
Result<engine::TimedLine> coarse_line(std::vector<engine::TimedStep> steps,
                                      engine::KnobLineConfig config) {
  const int top = config.last_step;
  const bool has_top = std::any_of(steps.begin(), steps.end(),
                                   [=](const engine::TimedStep& s) { return s.step == top; });
  for (engine::TimedStep& s : steps) s.step /= kHalf;
  config.last_step = top / kHalf;
  auto line = engine::knob_line(steps, config);
  if (!line) return line;
  const auto told = [&](int half) {
    return half == config.last_step && has_top ? top : half * kHalf;
  };
  for (double& value : line->values) {
    const int below = std::min(static_cast<int>(value), config.last_step - 1);
    value = told(below) + (value - below) * (told(below + 1) - told(below));
  }
  return line;
}

}  // namespace

Result<Recording> recording_of(const CaptureOptions& options, const KnobRecorder& recorder,
                               const MoveSpan& span) {
  Recording recording;
  recording.what =
      midi_value_text(options.value) + " of channel " + std::to_string(recorder.channel());
  recording.last_step = recorder.last_step();
  recording.unit = 1.0 / recorder.last_step();
  recording.unit_name = "steps";
  recording.scale = "0 to " + std::to_string(recorder.last_step()) + " is 0 to 1";
  recording.count = static_cast<std::size_t>(recorder.heard());
  const auto& moves = recorder.moves();
  if (moves.size() < 2 && !options.whole) {
    return fail(ErrorCode::value_out_of_range,
                recording.what + " never moved: told " + std::to_string(recorder.heard()) +
                    (recorder.heard() == 1 ? " time" : " times") + ", it stayed at " +
                    std::to_string(moves.empty() ? 0 : moves.front().step) +
                    "; --whole keeps that");
  }
  recording.steps = steps_of(moves, span.samples_per_unit);
  engine::KnobLineConfig config;
  config.ramp = span.ramp;
  config.last_step = recorder.last_step();
  if (options.whole) {
    config.begin = 0;
    config.end = span.end / span.samples_per_unit;
  }
  const bool coarse = is_coarse(recording.steps, recording.last_step);
  if (coarse) {
    recording.usual_tolerance = 0.5 * kHalf;
    recording.scale += ", told with 7 bits";
  }
  auto line = coarse ? coarse_line(recording.steps, config) : knob_line(recording.steps, config);
  if (!line) return line.error();
  recording.line = std::move(*line);
  for (double& value : recording.line.values) value /= recording.last_step;
  const double begin = recording.line.times.front();
  for (double& time : recording.line.times) time -= begin;
  for (engine::TimedStep& step : recording.steps) step.time = std::max(step.time - begin, 0.0);
  return recording;
}

Result<Recording> record_midi_file(const EnvOptions& options) {
  const CaptureOptions& capture = options.capture;
  const auto song = io::read_midi_file(capture.from);
  if (!song) return song.error();
  if (!options.quiet) say_warnings(capture.from, *song);
  if (capture.beats && song->time_base.ticks_per_quarter == 0) {
    return fail(ErrorCode::unsupported,
                "its ticks are parts of a second (SMPTE), so it has no beats: leave out --beats");
  }
  KnobRecorder recorder(capture.value, options.channel);
  ValueList others;
  const base::SampleTime end = play_moves(*song, capture.beats, [&](const base::MidiEvent& event) {
    recorder.hear(event);
    others.hear(event);
  });
  if (recorder.heard() == 0) {
    return fail(ErrorCode::unknown_name,
                "there is no " + midi_value_text(capture.value) +
                    (options.channel > 0 ? " on channel " + std::to_string(options.channel) : "") +
                    "; there are: " + others.text());
  }
  const double ramp = capture.beats ? ramp_in_beats(capture.ramp_s, *song) : capture.ramp_s;
  return recording_of(capture, recorder, {number_of(end), double(kClockHz), ramp});
}

}  // namespace knotwave::env
