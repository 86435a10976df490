// SPDX-License-Identifier: MIT
// Effects by their class, and by the parts of dsp/ and engine/ they are made of.
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/base/elementary.h"
#include "knotwave/curves/curve_file.h"
#include "knotwave/dsp/crossfade.h"
#include "knotwave/dsp/filter.h"
#include "knotwave/dsp/shaper.h"
#include "knotwave/engine/envelope_generator.h"
#include "knotwave/engine/envelope_patch_program.h"
#include "knotwave/plugins/factory.h"
#include "knotwave/plugins/plugin_list.h"

#include "plugin_cost.h"

namespace knotwave::bench {
namespace {

using Samples = std::vector<float>;

constexpr std::size_t kFrames = 64;
constexpr double kDriveDb = 6;

/// Four channels of sines that no two blocks share, worked out once.
class Input {
 public:
  explicit Input(std::size_t frames) {
    for (std::size_t channel = 0; channel < channels_.size(); ++channel) {
      for (std::size_t i = 0; i < frames * kBlocks; ++i) {
        const double phase =
            static_cast<double>(i) * (0.031 + 0.007 * static_cast<double>(channel));
        channels_[channel].push_back(static_cast<float>(0.8 * std::sin(phase)));
      }
    }
    frames_ = frames;
  }
  std::span<const float> at(std::size_t channel, int block) const {
    return std::span(channels_[channel])
        .subspan(static_cast<std::size_t>(block) % kBlocks * frames_, frames_);
  }

 private:
  static constexpr std::size_t kBlocks = 37;
  std::array<Samples, 4> channels_;
  std::size_t frames_ = 0;
};

curves::NurbsCurve shipped(std::string_view file, std::string_view name) {
  auto set = curves::parse_curves(plugins::factory_text(file), std::string(file));
  return *set->find_curve(name);
}

void set(plugins::Plugin& plugin, std::string_view word, double value) {
  plugin.set_parameter(plugin.info().parameters->of_word(word), value);
}

/// Any effect, its first two outputs heard. `play` says what happens in a block.
template <class Play>
double by_class(plugins::Plugin& plugin, std::size_t frames, int blocks, Play play) {
  if (!plugin.activate(kRate)) return std::numeric_limits<double>::quiet_NaN();
  const Input input(frames);
  std::vector<Samples> outputs(plugins::Block::kMostChannels, Samples(frames));
  std::size_t ins = 0, outs = 0;
  for (const auto& port : plugin.info().inputs) ins += static_cast<std::size_t>(port.channels);
  for (const auto& port : plugin.info().outputs) outs += static_cast<std::size_t>(port.channels);
  double sum = 0;
  std::array<const float*, plugins::Block::kMostChannels> in{};
  std::array<float*, plugins::Block::kMostChannels> out{};
  for (std::size_t i = 0; i < outs; ++i) out[i] = outputs[i].data();
  for (int block = 0; block < blocks; ++block) {
    for (std::size_t i = 0; i < ins; ++i) in[i] = input.at(i, block).data();
    plugin.begin({{in.data(), ins}, {out.data(), outs}, frames});
    play(plugin, block);
    plugin.render();
    sum += static_cast<double>(outputs[outs - 1][0]);
  }
  return sum;
}
constexpr auto kNothing = [](plugins::Plugin&, int) {};

double shaper_by_dsp(int blocks, bool blocks_dc) {
  const auto knee = dsp::ShaperProgram::create(shipped("curves/shapers.toml", "knee"));
  const Input input(kFrames);
  std::array<dsp::Shaper, 2> shapers;
  std::array<dsp::StateVariableFilter, 2> filters;
  const Samples drive(kFrames, static_cast<float>(base::db_to_gain(kDriveDb)));
  const Samples corner(kFrames, 5), resonance(kFrames, 0);
  std::array<Samples, 2> out{Samples(kFrames), Samples(kFrames)};
  double sum = 0;
  for (int block = 0; block < blocks; ++block) {
    for (std::size_t channel = 0; channel < 2; ++channel) {
      shapers[channel].render(*knee, drive, 1, input.at(channel, block), out[channel]);
      if (!blocks_dc) continue;
      filters[channel].render(dsp::FilterKind::high, kRate, corner, resonance, out[channel],
                              out[channel]);
    }
    sum += static_cast<double>(out[1][0]);
  }
  return sum;
}

double shaper_by_class(int blocks, bool blocks_dc) {
  const auto plugin = plugins::shaper_info().create();
  set(*plugin, "drive", kDriveDb);
  set(*plugin, "dc_block", blocks_dc ? 1 : 0);
  return by_class(*plugin, kFrames, blocks, kNothing);
}

double crossfade_by_dsp(int blocks) {
  const dsp::CrossfadeLaw law;
  const Input input(kFrames);
  const std::vector<double> positions(kFrames, 0.25);
  Samples a(kFrames), b(kFrames);
  std::array<Samples, 2> out{Samples(kFrames), Samples(kFrames)};
  double sum = 0;
  for (int block = 0; block < blocks; ++block) {
    law.render(positions, a, b);
    for (std::size_t channel = 0; channel < 2; ++channel) {
      const auto one = input.at(channel, block), other = input.at(channel + 2, block);
      for (std::size_t i = 0; i < kFrames; ++i) {
        out[channel][i] =
            static_cast<float>(static_cast<double>(a[i]) * static_cast<double>(one[i]) +
                               static_cast<double>(b[i]) * static_cast<double>(other[i]));
      }
    }
    sum += static_cast<double>(out[1][0]);
  }
  return sum;
}

/// A note of a second in every 1.5 s, and a controller in every fourth block of 64.
bool happens(int block, std::size_t frames, base::MidiEvent& event) {
  const std::int64_t sample = static_cast<std::int64_t>(block) * static_cast<std::int64_t>(frames);
  const auto in = [&](std::int64_t place, std::int64_t period) {
    const std::int64_t phase = (sample - place) % period;
    return phase >= 0 && phase < static_cast<std::int64_t>(frames);
  };
  const bool begins = in(0, 72000), ends = in(48000, 72000);
  if (begins || ends) {
    event.bytes[0] = begins ? 0x90 : 0x80;
    event.bytes[1] = 60;
    event.bytes[2] = 100;
    return true;
  }
  if (!in(64, 256)) return false;
  event.bytes[0] = 0xB0;
  event.bytes[1] = 1;
  event.bytes[2] = static_cast<std::uint8_t>(sample / 256 % 128);
  return true;
}

/// Keeps what the plugin does: messages, and volts as samples.
class Sink final : public engine::GeneratorSink {
 public:
  explicit Sink(std::size_t frames) : out_(8, Samples(frames)) {}
  void midi(int, const base::MidiEvent&) KNOTWAVE_RT override { ++sent_; }
  void osc(int, int, base::SampleTime, double) KNOTWAVE_RT override {}
  void volts(int channel, std::int64_t first, std::span<const double> values) KNOTWAVE_RT override {
    Samples& out = out_[static_cast<std::size_t>(channel) % out_.size()];
    for (std::size_t i = 0; i < values.size(); ++i) {
      out[(static_cast<std::size_t>(first) + i) % out.size()] = static_cast<float>(values[i] / 10);
    }
  }
  double sent() const { return sent_; }

 private:
  std::vector<Samples> out_;
  double sent_ = 0;
};

double envelope_by_engine(int blocks, std::size_t frames) {
  const std::string path = "envelopes/" + plugins::envelope_info().presets[0] + ".toml";
  const auto spec = engine::parse_envelope_patch(plugins::factory_text(path), path);
  if (!spec) return std::numeric_limits<double>::quiet_NaN();
  const auto program = engine::EnvelopePatchProgram::create(*spec);
  const engine::EnvelopePatchProgram* const patches[] = {program->get()};
  engine::EnvelopeGeneratorConfig config;
  config.rate_hz = kRate;
  config.lead_s = 0;
  const auto generator = engine::EnvelopeGenerator::create(config, patches);
  Sink sink(frames);
  for (int block = 0; block < blocks; ++block) {
    const std::int64_t begin = static_cast<std::int64_t>(block) * static_cast<std::int64_t>(frames);
    base::MidiEvent event;
    event.time.sample = begin;
    if (happens(block, frames, event)) (*generator)->handle(event);
    (*generator)->advance(begin + static_cast<std::int64_t>(frames), sink);
  }
  return sink.sent();
}

double envelope_by_class(int blocks, std::size_t frames) {
  const auto plugin = plugins::envelope_info().create();
  double sent = 0;
  by_class(*plugin, frames, blocks, [&](plugins::Plugin& playing, int block) {
    sent += static_cast<double>(playing.midi_out().size());
    engine::Event event;
    if (happens(block, frames, event.midi)) playing.add(event);
  });
  return sent;
}

}  // namespace

double by_effect(std::string_view way, int blocks) {
  for (const std::size_t frames : {16U, 64U, 512U}) {
    if (way == "envelope-engine-" + std::to_string(frames))
      return envelope_by_engine(blocks, frames);
    if (way == "envelope-" + std::to_string(frames)) return envelope_by_class(blocks, frames);
  }
  if (way == "shaper-dsp") return shaper_by_dsp(blocks, false);
  if (way == "shaper") return shaper_by_class(blocks, false);
  if (way == "shaper-dc-dsp") return shaper_by_dsp(blocks, true);
  if (way == "shaper-dc") return shaper_by_class(blocks, true);
  if (way == "crossfade-dsp") return crossfade_by_dsp(blocks);
  if (way == "crossfade") {
    const auto plugin = plugins::crossfade_info().create();
    set(*plugin, "position", 0.25);
    return by_class(*plugin, kFrames, blocks, kNothing);
  }
  if (way == "curve") {
    const auto plugin = plugins::curve_info().create();
    return by_class(*plugin, kFrames, blocks, [](plugins::Plugin& playing, int block) {
      plugins::Transport song;
      song.beats_per_minute = 120;
      song.has_position = song.is_playing = true;
      song.quarters = static_cast<double>(block) * kFrames * 2 / kRate;
      playing.add_transport(song, 0);
    });
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace knotwave::bench
