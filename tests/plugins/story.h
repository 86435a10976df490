// SPDX-License-Identifier: MIT
// What is played to a plugin in every format, and what the plugin itself makes of it.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "knotwave/plugins/plugin_list.h"

namespace knotwave::test {

using Channels = std::vector<std::vector<float>>;
/// How a host makes its one call of a block.
using CallBlock = std::function<void(const std::function<void()>& block)>;

/// Times count from the sound's first sample, in order; no two happen at one sample.
struct Story {
  struct Midi {
    std::size_t sample = 0;
    std::array<std::uint8_t, 3> bytes{};
    bool operator==(const Midi&) const = default;
  };
  struct Point {
    std::size_t sample = 0;
    std::size_t place = 0;
    double part = 0;  ///< of the parameter's range
  };
  /// What the host says of its song.
  struct Song {
    std::size_t sample = 0;
    plugins::Transport transport;
    int beats_per_bar = 4, beat_unit = 4;
    bool has_signature = true;
  };
  std::vector<Midi> midi;
  std::vector<Point> points;
  std::vector<Song> song;
  Channels inputs;  ///< of all ports that are audio, one channel after the other
  std::size_t frames = 0;

  /// What happens in [from, from + count), with times that count from `from`.
  Story part(std::size_t from, std::size_t count) const;
};

/// Notes, controllers and a bend where it takes MIDI, every parameter moved, noise in.
Story story_of(const plugins::PluginInfo& info, std::size_t frames);

/// Notes, noise, and a host that starts, changes its tempo, stops, goes on elsewhere, comes round a
/// loop, has no time signature and impossible ones, a tempo of 0, of NaN and none, and is before
/// its song. Everything happens at multiples of `step` and, if `off` is not 0, so much later. What
/// only follows a song does so.
Story story_with_song(const plugins::PluginInfo& info, std::size_t step, std::size_t off);
/// The same with the song told at every multiple of `block`, as most formats' hosts do.
Story told_every_block(const Story& story, double rate_hz, std::size_t block);

/// Whether a point counts at its sample, or at the begin of its block as a float.
enum class Points { at_their_sample, at_the_block };

double value_of(const plugins::Parameter& parameter, double part);
std::size_t audio_channels(std::span<const plugins::AudioPort> ports);
std::size_t channels(std::span<const plugins::AudioPort> ports);  ///< voltages too

/// What an active plugin makes of it: all outputs, voltages too, and its MIDI.
Channels play(plugins::Plugin& plugin, const Story& story, std::size_t block,
              Points points = Points::at_their_sample, std::vector<Story::Midi>* given = nullptr);
/// The same of a new one.
Channels played_by_itself(const plugins::PluginInfo& info, const Story& story, double rate_hz,
                          std::size_t block, Points points = Points::at_their_sample);

/// Notes and the song, of a plugin that gives MIDI for them, and what it gives.
Story story_for_midi(const plugins::PluginInfo& info);
std::vector<Story::Midi> midi_given_by_itself(const plugins::PluginInfo& info, const Story& story,
                                              std::size_t block);

/// "knotwave" of the instrument, "knotwave-shaper".
std::string file_of(const plugins::PluginInfo& info);

void append(Channels& to, const Channels& from);

}  // namespace knotwave::test
