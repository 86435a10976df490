// SPDX-License-Identifier: MIT
#include "story.h"

#include <algorithm>

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
  auto next = story.midi.begin();
  const auto add_midi_until = [&](std::size_t sample) {
    for (; next != story.midi.end() && next->sample < sample; ++next) {
      engine::Event event;
      event.midi.time.sample = static_cast<std::int64_t>(next->sample);
      std::ranges::copy(next->bytes, event.midi.bytes);
      plugin.add(event);
    }
  };
  if (points == Points::at_their_sample) {
    for (const Story::Point& point : story.points) {
      add_midi_until(point.sample);
      plugin.add_parameter(point.place, value_of((*info.parameters)[point.place], point.part),
                           static_cast<std::int64_t>(point.sample));
    }
  }
  add_midi_until(story.frames);
  plugin.render();
}
}  // namespace

Channels played_by_itself(const plugins::PluginInfo& info, const Story& story, double rate_hz,
                          std::size_t block, Points points) {
  const auto plugin = info.create();
  const auto active = plugin->activate(rate_hz);
  EXPECT_TRUE(active) << active.error().message;
  Channels all(channels(info.outputs)), part;
  for (std::size_t from = 0; from < story.frames; from += block) {
    play_block(*plugin, story.part(from, std::min(block, story.frames - from)), points, part);
    append(all, part);
  }
  return all;
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
