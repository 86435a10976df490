// SPDX-License-Identifier: MIT
#include "offline.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "knotwave/base/file.h"
#include "knotwave/base/sha256.h"
#include "knotwave/io/sound_file.h"

#include "cv_stream.h"
#include "dry_run.h"
#include "live.h"
#include "sent_plot.h"
#include "status.h"

namespace knotwave::env {
namespace {

constexpr std::size_t kWarningsShown = 20;
constexpr double kRampSeconds = 0.5;

Result<void> write_song(const EnvOptions& options, const DryRun& run) {
  std::size_t left_out = 0;
  const io::Song song = song_of(run.sent.messages(), run.names, run.end, left_out);
  if (left_out > 0) {
    std::fprintf(stderr, "%s: %zu messages of OSC or system have no place in a MIDI file\n",
                 io::printable(options.output, 4096).c_str(), left_out);
  }
  const auto bytes = io::write_midi(song);
  return base::write_file(options.output,
                          {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// Samples of control voltage into a file, and their hash.
class VoltageFile {
 public:
  static Result<VoltageFile> create(const EnvOptions& options, const EnvInput& input) {
    engine::VoltageConfig voltage;
    voltage.direct_current = true;  // no loudspeaker is there to be kept safe
    voltage.rate_hz = kClockHz;
    voltage.ramp_s = kRampSeconds;
    auto channels = read_calibration(options);
    if (!channels) return channels.error();
    voltage.channels = std::move(*channels);
    auto player = CvPlayer::create(voltage, options.seed, input.voltage_patches());
    if (!player) return player.error();
    if (player->channels() == 0) {
      return fail(ErrorCode::unsupported,
                  "no patch has an output to = \"cv\", so there is nothing for a .wav");
    }
    io::SoundWriteConfig config;
    config.path = options.output;
    config.rate_hz = kClockHz;
    config.channels = static_cast<int>(player->channels());
    config.format = io::SampleFormat::float32;
    auto writer = io::SoundWriter::create(config);
    if (!writer) return writer.error();
    return VoltageFile(std::move(*player), std::move(*writer));
  }

  CvPlayer& player() { return player_; }
  void play_until(std::int64_t until) {
    while (player_.now() < until && !fault_) {
      const auto n = static_cast<std::size_t>(std::min<std::int64_t>(
          until - player_.now(), static_cast<std::int64_t>(CvPlayer::kMostSamples)));
      std::vector<float*> out;
      for (auto& channel : channels_) out.push_back(channel.data());
      player_.render(n, out);
      for (std::size_t i = 0; i < n; ++i) {
        for (const auto& channel : channels_) frames_.push_back(channel[i]);
      }
      if (frames_.size() >= 1 << 16) flush();
    }
  }
  Result<std::string> finish() {
    flush();
    if (fault_) return *fault_;
    if (const auto done = writer_.finish(); !done) return done.error();
    return hash_.finish_hex();
  }

 private:
  VoltageFile(CvPlayer player, io::SoundWriter writer)
      : player_(std::move(player)), writer_(std::move(writer)), channels_(player_.channels()) {}
  void flush() {
    if (fault_) return;
    hash_.update(std::span<const float>(frames_));
    if (const auto written = writer_.write(frames_); !written) fault_ = written.error();
    frames_.clear();
  }

  CvPlayer player_;
  io::SoundWriter writer_;
  std::vector<std::array<float, CvPlayer::kMostSamples>> channels_;
  std::vector<float> frames_;
  base::Sha256 hash_;
  std::optional<Error> fault_;
};

/// The voltages of the song, of the tail, and of the ramp to 0 V behind it.
Result<std::string> write_voltages(const EnvOptions& options, const EnvInput& input,
                                   const io::Song& song) {
  auto file = VoltageFile::create(options, input);
  if (!file) return file.error();
  engine::Event event;
  play_song(
      song,
      [&](base::SampleTime time, std::uint32_t tempo) {
        file->play_until(base::first_sample(time));
        event.kind = engine::Event::Kind::tempo;
        event.midi = {};
        event.midi.time = time;
        event.microseconds_per_quarter = tempo;
        file->player().handle(event);
      },
      [&](const base::MidiEvent& midi) {
        file->play_until(base::first_sample(midi.time));
        event.kind = engine::Event::Kind::midi;
        event.midi = midi;
        file->player().handle(event);
      });
  const auto tail = static_cast<std::int64_t>(options.tail_s * kClockHz);
  const std::int64_t end =
      base::first_sample(io::TickClock(song, kClockHz).at(song.length_ticks)) + tail;
  file->play_until(end);
  file->player().ramp_out();
  file->play_until(end + static_cast<std::int64_t>(kRampSeconds * kClockHz) + 1);
  auto hash = file->finish();
  if (!hash) return hash.error();
  const auto seconds = static_cast<double>(file->player().now()) / kClockHz;
  std::string line = io::printable(options.output, 4096) + ": " + fixed(seconds, 3) + " s, " +
                     std::to_string(file->player().channels()) + " channels";
  if (file->player().clamped() > 0) {
    line += ", " + std::to_string(file->player().clamped()) + " samples beyond full scale";
  }
  return line + ", sha256 " + *hash;
}

}  // namespace

void say_warnings(const std::string& name, const io::Song& song) {
  for (std::size_t i = 0; i < song.warnings.size() && i < kWarningsShown; ++i) {
    const io::SongWarning& warning = song.warnings[i];
    std::fprintf(stderr, "%s: byte %zu: warning: %s\n", io::printable(name, 4096).c_str(),
                 warning.offset, io::printable(warning.message, 400).c_str());
  }
}

void say_left_out(const EnvOptions& options, const EnvInput& input) {
  for (const engine::EnvelopePatchProgram* patch : input.voltage_patches()) {
    std::fprintf(stderr, "%s: warning: the control voltage of '%s' is left out; a .wav holds it\n",
                 io::printable(options.output, 4096).c_str(),
                 io::printable(patch->spec().patch.name, 400).c_str());
  }
}

Result<std::string> run_offline(const EnvOptions& options, const EnvInput& input) {
  auto song = io::read_midi_file(options.dry_run);
  if (!song) return std::move(song).error();
  if (!options.quiet) say_warnings(options.dry_run, *song);
  auto run = dry_run(options, input, *song);
  if (!run) return run.error();
  // No device is opened, but a name that would be refused live is refused here.
  if (const auto known = output_ports(options, run->port_specs); !known) return known.error();
  const bool is_sound = base::has_ending(options.output, ".wav");
  if (!is_sound && !options.output.empty() && !options.quiet) say_left_out(options, input);
  std::string lines, voltage_line;
  if (base::has_ending(options.output, ".mid")) {
    if (const auto written = write_song(options, *run); !written) return written.error();
  } else if (base::has_ending(options.output, ".csv")) {
    const auto written = base::write_file(options.output, csv_of(run->sent.messages(), run->names));
    if (!written) return written.error();
  } else if (!options.output.empty()) {
    auto line = write_voltages(options, input, *song);
    if (!line) return line.error();
    voltage_line = *line + "\n";
  }
  if (!options.plot.empty()) {
    const auto svg = plot_of(options, input, *song, *run);
    if (!svg) return svg.error();
    if (const auto written = base::write_file(options.plot, *svg); !written) return written.error();
  }
  if (options.monitor) {
    for (const SentMessage& message : run->sent.messages()) {
      lines +=
          seconds_text(message.time, kClockHz) + " " +
          (message.port < 0 ? "osc" : run->names.ports[static_cast<std::size_t>(message.port)]) +
          " " + message_text(message, run->names) + "\n";
    }
  }
  return lines + dry_run_line(*run, is_sound ? "" : options.output) + "\n" + voltage_line;
}

}  // namespace knotwave::env
