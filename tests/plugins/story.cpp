// SPDX-License-Identifier: MIT
#include "story.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

namespace knotwave::test {

Story Story::part(std::size_t from, std::size_t count) const {
  Story cut;
  cut.frames = count;
  for (Midi event : midi) {
    if (event.sample < from || event.sample >= from + count) continue;
    event.sample -= from;
    cut.midi.push_back(event);
  }
  for (Point point : points) {
    if (point.sample < from || point.sample >= from + count) continue;
    point.sample -= from;
    cut.points.push_back(point);
  }
  for (Song told : song) {
    if (told.sample < from || told.sample >= from + count) continue;
    told.sample -= from;
    cut.song.push_back(told);
  }
  for (const std::vector<float>& channel : inputs) {
    const auto begin = channel.begin() + static_cast<std::ptrdiff_t>(from);
    cut.inputs.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(count));
  }
  return cut;
}

double value_of(const plugins::Parameter& parameter, double part) {
  return held(parameter, parameter.low + part * (parameter.high - parameter.low));
}

std::size_t channels(std::span<const plugins::AudioPort> ports) {
  std::size_t count = 0;
  for (const plugins::AudioPort& port : ports) count += static_cast<std::size_t>(port.channels);
  return count;
}

std::size_t audio_channels(std::span<const plugins::AudioPort> ports) {
  std::size_t count = 0;
  for (const plugins::AudioPort& port : ports) {
    count += port.is_voltage ? 0u : static_cast<std::size_t>(port.channels);
  }
  return count;
}

Story story_of(const plugins::PluginInfo& info, std::size_t frames) {
  Story story;
  story.frames = frames;
  if (info.takes_midi) {
    const auto part = [&](std::size_t of_1000) { return frames * of_1000 / 1000; };
    story.midi = {
        {part(2), {0x90, 48, 100}},  {part(4), {0x90, 60, 1}},     {part(5), {0x90, 64, 127}},
        {part(60), {0xB0, 64, 127}}, {part(80), {0xE0, 0, 80}},    {part(90), {0xE0, 127, 127}},
        {part(95), {0xB0, 1, 77}},   {part(120), {0x80, 64, 64}},  {part(130), {0x93, 72, 33}},
        {part(140), {0xD3, 99, 0}},  {part(150), {0xA3, 72, 111}}, {part(200), {0xE0, 0, 64}},
        {part(300), {0xB0, 64, 0}},  {part(400), {0x80, 48, 0}},   {part(410), {0x80, 60, 127}},
        {part(600), {0x83, 72, 1}},
    };
  }
  const std::size_t count = info.parameters->size();
  for (std::size_t i = 0; i < 3 * count; ++i) {  // back to where it began in the end
    const plugins::Parameter& parameter = (*info.parameters)[i % count];
    const double initial = (parameter.initial - parameter.low) / (parameter.high - parameter.low);
    const double away = initial + (i < count ? 0.0625 : -0.03125);
    const double part = i < 2 * count ? std::clamp(away, 0.0, 1.0) : initial;
    story.points.push_back({(i * frames / (4 * count)) | 1u, i % count, part});
  }
  for (Story::Midi& event : story.midi) event.sample &= ~std::size_t{1};
  std::uint64_t state = 4711;
  story.inputs.resize(audio_channels(info.inputs));
  for (std::vector<float>& channel : story.inputs) {
    for (std::size_t i = 0; i < frames; ++i) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      channel.push_back(static_cast<float>(static_cast<std::int32_t>(state >> 33) - (1 << 30)) *
                        0x1p-31F);
    }
  }
  return story;
}

Story story_with_song(const plugins::PluginInfo& info, std::size_t step, std::size_t off) {
  Story story = story_of(info, 100 * step);
  story.points.clear();
  const std::size_t source = info.parameters->of_word("source");
  if (info.key == "crossfade") story.points = {{1, source, 0.5}};  // its motion
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto tell = [&](std::size_t steps, double bpm, double quarters, bool plays = true,
                        int beats_per_bar = 4, int beat_unit = 4) {
    const plugins::Transport transport{bpm, quarters, plays, true};
    story.song.push_back({steps * step + off, transport, beats_per_bar, beat_unit});
  };
  tell(10, 133.7, 3.25);
  tell(20, 90, 7.5);
  tell(30, 90, 40.125, false);
  tell(35, 90, 16);
  tell(42, 90, 8);
  tell(50, 90, 21.5, true, 3, 8);
  tell(58, 90, 5.25, true, 1, 8);  // a bar of half a quarter note
  tell(66, 95, 0);
  story.song.back().transport.has_position = story.song.back().has_signature = false;
  tell(70, 0, 11.75);
  tell(76, nan, 30.5);
  tell(82, 300, 64);
  tell(92, 140, -2.5);
  return story;
}

Story told_every_block(const Story& story, double rate_hz, std::size_t block) {
  Story often = story;
  often.song.clear();
  double bpm = 120;
  for (std::size_t i = 0; i < story.song.size(); ++i) {
    Story::Song told = story.song[i];
    if (told.transport.beats_per_minute > 0) bpm = told.transport.beats_per_minute;
    const std::size_t end = i + 1 < story.song.size() ? story.song[i + 1].sample : story.frames;
    for (; told.sample < end; told.sample += block) {
      often.song.push_back(told);
      if (!told.transport.is_playing) continue;
      told.transport.quarters += static_cast<double>(block) * bpm / (60 * rate_hz);
    }
  }
  return often;
}

namespace {
void play_block(plugins::Plugin& plugin, const Story& story, Points points, Channels& out) {
  const plugins::PluginInfo& info = plugin.info();
  std::array<const float*, plugins::Block::kMostChannels> in{};
  std::array<float*, plugins::Block::kMostChannels> given{};
  for (std::size_t i = 0; i < story.inputs.size(); ++i) in[i] = story.inputs[i].data();
  out.assign(channels(info.outputs), std::vector<float>(story.frames));
  for (std::size_t i = 0; i < out.size(); ++i) given[i] = out[i].data();
  if (points == Points::at_the_block) {
    for (const Story::Point& point : story.points) {
      const double value = value_of((*info.parameters)[point.place], point.part);
      plugin.set_parameter(point.place, static_cast<double>(static_cast<float>(value)));
    }
  }
  plugin.begin({{in.data(), channels(info.inputs)}, {given.data(), out.size()}, story.frames});
  auto told = story.song.begin();
  const auto tell_song_until = [&](std::size_t sample) {
    for (; told != story.song.end() && told->sample <= sample; ++told) {
      plugin.add_transport(told->transport, static_cast<std::int64_t>(told->sample));
    }
  };
  auto next = story.midi.begin();
  const auto add_midi_until = [&](std::size_t sample) {
    for (; next != story.midi.end() && next->sample < sample; ++next) {
      tell_song_until(next->sample);
      engine::Event event;
      event.midi.time.sample = static_cast<std::int64_t>(next->sample);
      std::ranges::copy(next->bytes, event.midi.bytes);
      plugin.add(event);
    }
  };
  if (points == Points::at_their_sample) {
    for (const Story::Point& point : story.points) {
      add_midi_until(point.sample);
      tell_song_until(point.sample);
      plugin.add_parameter(point.place, value_of((*info.parameters)[point.place], point.part),
                           static_cast<std::int64_t>(point.sample));
    }
  }
  add_midi_until(story.frames);
  tell_song_until(story.frames);
  plugin.render();
}
}  // namespace

Channels play(plugins::Plugin& plugin, const Story& story, std::size_t block, Points points,
              std::vector<Story::Midi>* given) {
  Channels all(channels(plugin.info().outputs)), part;
  for (std::size_t from = 0; from < story.frames; from += block) {
    play_block(plugin, story.part(from, std::min(block, story.frames - from)), points, part);
    append(all, part);
    for (const base::MidiEvent& event : plugin.midi_out()) {
      if (given == nullptr) continue;
      const auto sample = from + static_cast<std::size_t>(event.time.sample);
      given->push_back({sample, {event.bytes[0], event.bytes[1], event.bytes[2]}});
    }
  }
  return all;
}

Channels played_by_itself(const plugins::PluginInfo& info, const Story& story, double rate_hz,
                          std::size_t block, Points points) {
  const auto plugin = info.create();
  const auto active = plugin->activate(rate_hz);
  EXPECT_TRUE(active) << active.error().message;
  return play(*plugin, story, block, points);
}

Story story_for_midi(const plugins::PluginInfo& info) {
  Story story = told_every_block(story_with_song(info, 480, 0), 48000, 480);
  story.points.clear();
  return story;
}

std::vector<Story::Midi> midi_given_by_itself(const plugins::PluginInfo& info, const Story& story,
                                              std::size_t block) {
  const auto plugin = info.create();
  EXPECT_TRUE(plugin->activate(48000));
  std::vector<Story::Midi> given;
  play(*plugin, story, block, Points::at_their_sample, &given);
  return given;
}

std::string file_of(const plugins::PluginInfo& info) {
  return info.key == "instrument" ? "knotwave" : "knotwave-" + std::string(info.key);
}

void append(Channels& to, const Channels& from) {
  to.resize(std::max(to.size(), from.size()));
  for (std::size_t i = 0; i < from.size(); ++i) {
    to[i].insert(to[i].end(), from[i].begin(), from[i].end());
  }
}

}  // namespace knotwave::test
