// SPDX-License-Identifier: MIT
// What is played to a plugin in every format, and what the plugin itself makes of it.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "knotwave/plugins/plugin_list.h"

namespace knotwave::test {

using Channels = std::vector<std::vector<float>>;

/// Times count from the sound's first sample, in order; no two happen at one sample.
struct Story {
  struct Midi {
    std::size_t sample = 0;
    std::array<std::uint8_t, 3> bytes{};
  };
  struct Point {
    std::size_t sample = 0;
    std::size_t place = 0;
    double part = 0;  ///< of the parameter's range
  };
  std::vector<Midi> midi;
  std::vector<Point> points;
  Channels inputs;  ///< of all ports that are audio, one channel after the other
  std::size_t frames = 0;

  /// What happens in [from, from + count), with times that count from `from`.
  Story part(std::size_t from, std::size_t count) const;
};

/// Notes, controllers and a bend where it takes MIDI, every parameter moved, noise in.
Story story_of(const plugins::PluginInfo& info, std::size_t frames);

/// Whether a point counts at its sample, or at the begin of its block as a float.
enum class Points { at_their_sample, at_the_block };

double value_of(const plugins::Parameter& parameter, double part);
std::size_t audio_channels(std::span<const plugins::AudioPort> ports);
std::size_t channels(std::span<const plugins::AudioPort> ports);  ///< voltages too

/// Of all outputs, voltages too.
Channels played_by_itself(const plugins::PluginInfo& info, const Story& story, double rate_hz,
                          std::size_t block, Points points = Points::at_their_sample);

/// "knotwave" of the instrument, "knotwave-shaper".
std::string file_of(const plugins::PluginInfo& info);

void append(Channels& to, const Channels& from);

}  // namespace knotwave::test
