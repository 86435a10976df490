// SPDX-License-Identifier: MIT
// All that is known of a running synth, as page, log line and JSON show it.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "knotwave/curves/nurbs_curve.h"
#include "knotwave/engine/live_engine.h"
#include "knotwave/io/audio_device.h"
#include "knotwave/io/midi_input.h"

namespace knotwave::synth {

struct SynthStatus {
  double seconds = 0;      ///< since the start
  std::string patch;       ///< the file, or the demo's name
  std::string patch_name;  ///< of what sounds, or would: as the patch says it
  io::AudioFormat format;
  io::AudioStatus stream;
  bool is_lost = false;  ///< the device has gone; lost_reason says how
  std::string lost_reason;
  engine::LiveStatus live;
  std::vector<io::MidiPortStatus> midi;
  double clock_bpm = 0, clock_jitter_ms = 0;  ///< of a MIDI clock; 0: none came
  std::vector<std::string> knobs_to_turn;     ///< that were learnt, and are not picked up
  std::string osc;                            ///< where it listens; empty: it does not
  std::int64_t osc_messages = 0, osc_faults = 0;
  std::string song;                      ///< that plays by itself; empty: none, or it is over
  double song_s = 0, song_length_s = 0;  ///< how far it is, of how much
  std::string recording;                 ///< the file; empty: nothing is recorded
  double recorded_s = 0;
  bool has_keys = false;
  int octave = 4;
  bool is_help_shown = false;
  const curves::NurbsCurve* envelope = nullptr;  ///< the amp curve that is played; or none
  std::vector<std::string> messages;             ///< told so far, the newest last
};

/// Of a peak; -infinity for silence.
double dbfs(float peak);

/// A MIDI message as a sentence: `note on C4 (60), velocity 96, channel 1`. Empty for none.
std::string midi_words(const std::uint8_t (&bytes)[3]);

/// `1:02.5` of 62.5 seconds, `1:00:00.0` of an hour.
std::string clock_text(double seconds);

/// One line for a log, without what changes all the time anyway (load, levels, time), so that equal
/// lines mean that nothing happened.
std::string plain_line(const SynthStatus& status);

/// One JSON object in one line; docs/live.md lists the fields.
std::string json_line(const SynthStatus& status);

}  // namespace knotwave::synth
