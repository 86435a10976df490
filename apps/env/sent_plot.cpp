// SPDX-License-Identifier: MIT
#include "sent_plot.h"

#include <algorithm>

#include "knotwave/curves/plot_traces.h"
#include "knotwave/engine/midi_value.h"

#include "patch_players.h"
#include "status.h"

namespace knotwave::env {
namespace {

using engine::OutputKind;
using Points = std::vector<std::pair<double, double>>;

constexpr double kPairSeconds = 0.003;  // halves this near to one another are one value

double seconds_of(base::SampleTime time) {
  return (static_cast<double>(time.sample) + static_cast<double>(time.fraction) * 0x1p-32) /
         kClockHz;
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
  engine::MidiValue value({spec.kind, spec.number, spec.bits});
  const int middle = spec.kind == OutputKind::pitch_bend ? 8192 : 0;
  Points points;
  for (const SentMessage& message : messages) {
    const bool is_osc = message.patch == patch && message.output == output;
    if (spec.kind == OutputKind::osc) {
      if (message.port < 0 && is_osc) points.emplace_back(seconds_of(message.time), message.number);
      continue;
    }
    const bool is_channel = spec.channel == 0 || (message.bytes[0] & 15) == spec.channel - 1;
    if (message.port != port || message.bytes[0] >= 0xF0 || !is_channel) continue;
    if (!value.hear(message.bytes)) continue;
    const double time_s = seconds_of(message.time);
    if (value.completes() && !points.empty() && time_s - points.back().first < kPairSeconds) {
      points.pop_back();
    }
    points.emplace_back(time_s, value.step() - middle);
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
      panel.title = source_name(spec, output) + " to " + destination_text(output);
      panel.y_name = output.kind == OutputKind::voltage ? "volts" : "value";
      panel.traces.push_back({"curve", std::move((*curves)[p][o]), false});
      if (output.kind == OutputKind::voltage) continue;
      panel.traces.push_back({"sent",
                              received(run.sent.messages(), run.output_ports[p][o],
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
