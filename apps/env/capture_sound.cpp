// SPDX-License-Identifier: MIT
// How loud a sound file is, as a recording.
#include <cstdio>
#include <filesystem>

#include "knotwave/base/document.h"
#include "knotwave/io/midi_file.h"
#include "knotwave/io/sound_file.h"

#include "capture.h"

namespace knotwave::env {
namespace {

std::string scale_text(const CaptureOptions& options) {
  if (options.floor_db == 0) return "full scale is 1";
  return base::number_text(options.floor_db) + " dB to 0 dB is 0 to 1";
}

std::string measure_text(const CaptureOptions& options) {
  const bool is_peak = options.measure == dsp::LoudnessConfig::Measure::peak;
  return std::string(is_peak ? "peak" : "rms") + " over " + base::number_text(options.window_s) +
         " s each " + base::number_text(options.hop_s) + " s of " +
         io::printable(std::filesystem::path(options.from).filename().string(), 255);
}

}  // namespace

Result<Recording> record_sound_file(const EnvOptions& options) {
  const CaptureOptions& capture = options.capture;
  const auto sound = io::read_sound(capture.from);
  if (!sound) return sound.error();
  for (const std::string& warning : sound->warnings) {
    if (options.quiet) break;
    std::fprintf(stderr, "%s: warning: %s\n", io::printable(capture.from, 4096).c_str(),
                 io::printable(warning, 400).c_str());
  }
  auto meter = dsp::LoudnessMeter::create({.measure = capture.measure,
                                           .rate_hz = sound->rate_hz,
                                           .channels = sound->channels,
                                           .window_s = capture.window_s,
                                           .hop_s = capture.hop_s});
  if (!meter) return meter.error();
  meter->add(sound->samples);
  meter->finish();
  Recording recording;
  recording.what = measure_text(capture);
  recording.scale = scale_text(capture);
  recording.count = meter->levels().size();
  const bool is_db = capture.floor_db < 0;
  recording.unit = is_db ? -1 / capture.floor_db : 1;
  recording.unit_name = is_db ? "dB" : "";
  recording.usual_tolerance = is_db ? 0.5 : 0.01;
  const double units_per_s = capture.beats ? options.bpm / 60 : 1;
  for (const auto& [frame, level] : meter->levels()) {
    recording.line.times.push_back(static_cast<double>(frame) / sound->rate_hz * units_per_s);
    recording.line.values.push_back(is_db ? dsp::level_on_db_scale(level, capture.floor_db)
                                          : level);
  }
  return recording;
}

}  // namespace knotwave::env
