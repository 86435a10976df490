// SPDX-License-Identifier: MIT
#include "dry_run.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"

#include "status.h"

namespace knotwave::env {
namespace {

constexpr std::int64_t kMostSamples = std::int64_t{24} * 3600 * kClockHz;
constexpr std::int64_t kMostToRest = std::int64_t{30} * kClockHz;
constexpr std::int64_t kStep = kClockHz / 100;

double bytes_of_cable(engine::PortSpec::Wire wire) {
  return wire == engine::PortSpec::Wire::din ? engine::kDinBytesPerSecond : 0;
}

std::vector<PortUse> uses_of(const engine::EnvelopeGenerator& generator, const SentNames& names,
                             double seconds) {
  std::vector<PortUse> uses;
  for (std::size_t i = 0; i < generator.ports().size(); ++i) {
    const engine::PortCounters& counters = generator.port_counters(static_cast<int>(i));
    PortUse& use = uses.emplace_back();
    use.name = names.ports[i];
    use.messages = counters.messages;
    use.bytes = counters.bytes;
    use.bytes_per_second = seconds > 0 ? static_cast<double>(counters.bytes) / seconds : 0;
    const double most = bytes_of_cable(generator.ports()[i].wire);
    use.share = most > 0 ? use.bytes_per_second / most : 0;
  }
  return uses;
}

}  // namespace

Result<DryRun> dry_run(const EnvOptions& options, const EnvInput& input, const io::Song& song) {
  auto made = make_generator(options, input);
  if (!made) return made.error();
  engine::EnvelopeGenerator& generator = **made;
  const std::int64_t song_end =
      base::first_sample(io::TickClock(song, kClockHz).at(song.length_ticks));
  if (song_end > kMostSamples) {
    return fail(ErrorCode::value_out_of_range, "the song lasts " +
                                                   std::to_string(song_end / kClockHz) +
                                                   " s, more than a day: is its tempo right?");
  }
  DryRun run;
  run.names = names_of(generator, input);
  run.port_specs = generator.ports();
  const auto go_to = [&](base::SampleTime time) {
    if (time.sample > generator.now()) generator.advance(time.sample, run.sent);
  };
  play_song(
      song,
      [&](base::SampleTime time, std::uint32_t tempo) {
        go_to(time);
        generator.set_tempo(time, tempo);
      },
      [&](const base::MidiEvent& event) {
        go_to(event.time);
        generator.handle(event);
        ++run.messages_in;
      });
  for (const auto& program : input.programs) {
    run.output_ports.emplace_back(program->spec().outputs.size(), -1);
  }
  for (const engine::RouteStatus& route : generator.routes()) {
    auto& ports = run.output_ports[static_cast<std::size_t>(route.patch)];
    ports[static_cast<std::size_t>(route.output)] = route.port;
  }
  go_to({song_end + std::lround(options.tail_s * kClockHz), 0});
  generator.go_to_rest();
  const std::int64_t latest = generator.now() + kMostToRest;
  while (!generator.is_at_rest() && generator.now() < latest) {
    generator.advance(generator.now() + kStep, run.sent);
  }
  run.came_to_rest = generator.is_at_rest();
  run.end = generator.now();
  run.lost = generator.lost();
  for (int port = 0; port < static_cast<int>(generator.ports().size()); ++port) {
    run.lost += generator.port_counters(port).lost;
    run.overload_bytes += generator.port_counters(port).overload_bytes;
  }
  run.sent.sort();
  run.ports = uses_of(generator, run.names, static_cast<double>(run.end) / kClockHz);
  return run;
}

std::string dry_run_line(const DryRun& run, const std::string& path) {
  std::string line = (path.empty() ? "dry run" : io::printable(path, 4096)) + ": " +
                     fixed(static_cast<double>(run.end) / kClockHz, 3) + " s, " +
                     std::to_string(run.messages_in) + " messages in, " +
                     std::to_string(run.sent.messages().size()) + " out";
  for (const PortUse& port : run.ports) {
    if (port.messages == 0) continue;
    line += ", " + io::printable(port.name) + " " + std::to_string(port.messages) + " (" +
            fixed(port.bytes_per_second, 0) + " B/s";
    if (port.share > 0) line += ", " + fixed(port.share * 100, 1) + " %";
    line += ")";
  }
  if (run.overload_bytes > 0) {
    line += ", " + std::to_string(run.overload_bytes) + " bytes passed through waited over 20 ms";
  }
  if (run.lost > 0) line += ", " + std::to_string(run.lost) + " lost for want of room";
  if (!run.came_to_rest) line += ", not at rest after 30 s";
  return line + ", sha256 " + run.sent.sha256();
}

}  // namespace knotwave::env
