// SPDX-License-Identifier: MIT
#include "sent_plot.h"

#include <algorithm>

#include "knotwave/curves/plot_traces.h"

#include "patch_players.h"
#include "status.h"

namespace knotwave::env {
namespace {

using base::MidiStatus;
using engine::OutputKind;
using Points = std::vector<std::pair<double, double>>;

constexpr double kPairSeconds = 0.003;  // halves this near to one another are one value

double seconds_of(base::SampleTime time) {
  return (static_cast<double>(time.sample) + static_cast<double>(time.fraction) * 0x1p-32) /
         kClockHz;
}

/// Controllers and parameters as a receiver understands them.
class Receiver {
 public:
  explicit Receiver(const engine::OutputSpec& spec) : spec_(spec) {}

  /// True when `value()` was told anew.
  bool hears(const SentMessage& message) {
    const int one = message.bytes[1], two = message.bytes[2];
    switch (static_cast<MidiStatus>(message.bytes[0] & 0xF0)) {
      case MidiStatus::control_change:
        return hears_control(one, two);
      case MidiStatus::pitch_bend:
        value_ = (two << 7 | one) - 8192;
        return spec_.kind == OutputKind::pitch_bend;
      case MidiStatus::channel_pressure:
        value_ = one;
        return spec_.kind == OutputKind::channel_pressure;
      case MidiStatus::poly_pressure:
        value_ = two;
        return spec_.kind == OutputKind::poly_pressure;
      default:
        return false;
    }
  }
  double value() const { return value_; }
  /// The message was a lower half, so the upper one before it was no value by itself.
  bool is_second() const { return is_second_; }

 private:
  bool hears_control(int number, int value) {
    if (spec_.kind == OutputKind::nrpn) {
      if (number == 99) parameter_ = value << 7 | (parameter_ & 127);
      if (number == 98) parameter_ = (parameter_ & ~127) | value;
      const bool is_data = number == 6 || number == 38;
      return is_data && parameter_ == spec_.number && hears_half(number == 6, value);
    }
    if (spec_.kind != OutputKind::control) return false;
    const bool is_low = spec_.bits == 14 && number == spec_.number + 32;
    return (number == spec_.number || is_low) && hears_half(!is_low, value);
  }
  // An upper half puts the lower one to 0 (MIDI 1.0), until that follows.
  bool hears_half(bool is_high, int value) {
    if (is_high) {
      high_ = value;
      low_ = 0;
    } else {
      low_ = value;
    }
    is_second_ = !is_high;
    value_ = spec_.bits == 14 ? high_ << 7 | low_ : high_;
    return true;
  }

  const engine::OutputSpec& spec_;
  int parameter_ = 16383, high_ = 0, low_ = 0;
  double value_ = 0;
  bool is_second_ = false;
};

/// The port that an output of MIDI goes to.
int port_of(const EnvInput& input, const SentNames& names, std::size_t patch,
            const engine::OutputSpec& spec) {
  std::string name = spec.port;
  const auto& ports = input.programs[patch]->spec().ports;
  if (name.empty() && !ports.empty()) name = ports.front().name;
  const auto found = std::find(names.ports.begin(), names.ports.end(), name);
  return found == names.ports.end() ? 0 : static_cast<int>(found - names.ports.begin());
}

/// Numbers of every output over time, some 4000 a run.
Result<std::vector<std::vector<Points>>> curves_of(const EnvOptions& options, const EnvInput& input,
                                                   const io::Song& song, std::int64_t end) {
  auto made = PatchPlayers::create(kClockHz, options.seed, input.patches());
  if (!made) return made.error();
  PatchPlayers& players = *made;
  std::vector<std::vector<Points>> all(players.size());
  for (std::size_t p = 0; p < players.size(); ++p) all[p].resize(players.spec(p).outputs.size());
  const std::int64_t every = std::max<std::int64_t>(end / 4000, 1);
  const auto keep = [&](std::int64_t first, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      const std::int64_t sample = first + static_cast<std::int64_t>(i);
      if (sample % every != 0) continue;
      for (std::size_t p = 0; p < players.size(); ++p) {
        for (std::size_t o = 0; o < all[p].size(); ++o) {
          all[p][o].emplace_back(seconds_of({sample, 0}), players.values(p, o)[i]);
        }
      }
    }
    for (std::size_t p = 0; p < players.size(); ++p) players.player(p).take_messages();
  };
  engine::Event event;
  play_song(
      song,
      [&](base::SampleTime time, std::uint32_t tempo) {
        players.render_until(time.sample, keep);
        event.kind = engine::Event::Kind::tempo;
        event.midi.time = time;
        event.microseconds_per_quarter = tempo;
        players.handle(event);
      },
      [&](const base::MidiEvent& midi) {
        players.render_until(midi.time.sample, keep);
        event.kind = engine::Event::Kind::midi;
        event.midi = midi;
        players.handle(event);
      });
  players.render_until(end, keep);
  return all;
}

}  // namespace

Points received(std::span<const SentMessage> messages, int port, int patch, int output,
                const engine::OutputSpec& spec) {
  Receiver receiver(spec);
  Points points;
  for (const SentMessage& message : messages) {
    const bool is_osc = message.patch == patch && message.output == output;
    if (spec.kind == OutputKind::osc) {
      if (message.port < 0 && is_osc) points.emplace_back(seconds_of(message.time), message.number);
      continue;
    }
    const bool is_channel = spec.channel == 0 || (message.bytes[0] & 15) == spec.channel - 1;
    if (message.port != port || message.bytes[0] >= 0xF0 || !is_channel) continue;
    if (!receiver.hears(message)) continue;
    const double time_s = seconds_of(message.time);
    if (receiver.is_second() && !points.empty() && time_s - points.back().first < kPairSeconds) {
      points.pop_back();
    }
    points.emplace_back(time_s, receiver.value());
  }
  return points;
}

Result<std::string> plot_of(const EnvOptions& options, const EnvInput& input, const io::Song& song,
                            const DryRun& run) {
  auto curves = curves_of(options, input, song, run.end);
  if (!curves) return curves.error();
  std::vector<curves::PlotPanel> panels;
  for (std::size_t p = 0; p < input.programs.size(); ++p) {
    const engine::EnvelopePatchSpec& spec = input.programs[p]->spec();
    for (std::size_t o = 0; o < spec.outputs.size(); ++o) {
      const engine::OutputSpec& output = spec.outputs[o];
      curves::PlotPanel& panel = panels.emplace_back();
      panel.title = source_text(spec, output) + " to " + destination_text(output);
      panel.y_name = output.kind == OutputKind::voltage ? "volts" : "value";
      panel.traces.push_back({"curve", std::move((*curves)[p][o]), false});
      if (output.kind == OutputKind::voltage) continue;
      panel.traces.push_back({"sent",
                              received(run.sent.messages(), port_of(input, run.names, p, output),
                                       static_cast<int>(p), static_cast<int>(o), output),
                              true});
    }
  }
  curves::PlotOptions plot;
  plot.width_px = 1200;
  plot.height_px = 360;
  return curves::plot_svg(panels, "seconds", plot);
}

}  // namespace knotwave::env
