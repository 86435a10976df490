// SPDX-License-Identifier: MIT
#include "effect_host.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include "knotwave/base/elementary.h"
#include "knotwave/base/random.h"
#include "knotwave/base/sha256.h"

#include "support/seed.h"

namespace knotwave::support {

using plugins::Plugin;

HostAction set_at(std::int64_t sample, std::size_t place, double value) {
  return {sample, [place, value](Plugin& plugin, std::int64_t offset) {
            plugin.add_parameter(place, value, offset);
          }};
}

HostAction transport_at(std::int64_t sample, const plugins::Transport& transport) {
  return {sample, [transport](Plugin& plugin, std::int64_t offset) {
            plugin.add_transport(transport, offset);
          }};
}

Channels play(Plugin& plugin, const Channels& in, const HostRun& run) {
  const std::size_t samples = in.front().size();
  std::size_t outputs = 0;
  for (const auto& port : plugin.info().outputs) outputs += static_cast<std::size_t>(port.channels);
  Channels input = in;
  Channels out(outputs, std::vector<float>(samples, 99));
  std::vector<const float*> from(in.size());
  std::vector<float*> to(outputs);
  auto action = run.actions.begin();
  for (std::size_t first = 0; first < samples;) {
    const std::size_t frames = std::clamp<std::size_t>(run.block(), 1, samples - first);
    for (std::size_t c = 0; c < outputs; ++c) {
      to[c] = (run.in_place && c < in.size() ? input[c] : out[c]).data() + first;
    }
    for (std::size_t c = 0; c < in.size(); ++c) from[c] = input[c].data() + first;
    plugin.begin({from, to, frames});
    for (; action != run.actions.end() && action->sample < std::int64_t(first + frames); ++action) {
      action->act(plugin, action->sample - std::int64_t(first));
    }
    plugin.render();
    first += frames;
  }
  if (!run.in_place) return out;
  for (std::size_t c = 0; c < std::min(outputs, in.size()); ++c) out[c] = input[c];
  return out;
}

std::size_t place_of(const plugins::PluginInfo& info, const std::string& word) {
  const std::size_t place = info.parameters->of_word(word);
  EXPECT_LT(place, info.parameters->size()) << word;
  return place;
}

void set(Plugin& plugin, const Settings& settings) {
  for (const auto& [word, text] : settings) {
    const std::size_t place = place_of(plugin.info(), word);
    const auto value = plugins::parameter_value((*plugin.info().parameters)[place], text);
    ASSERT_TRUE(value) << value.error().to_string();
    plugin.set_parameter(place, *value);
  }
}

std::unique_ptr<Plugin> active(const plugins::PluginInfo& info, const Settings& settings,
                               double rate_hz) {
  auto plugin = info.create();
  set(*plugin, settings);
  const auto activated = plugin->activate(rate_hz);
  EXPECT_TRUE(activated) << (activated ? "" : activated.error().to_string());
  return plugin;
}

Channels music(std::size_t channels, std::size_t samples, float level) {
  Channels all(channels, std::vector<float>(samples));
  const base::RandomStream random{6101};
  for (std::size_t c = 0; c < channels; ++c) {
    const double step = 0.0017 * static_cast<double>(c + 1);
    for (std::size_t i = 0; i < samples; ++i) {
      const double t = static_cast<double>(i);
      const double noise = random.bipolar(c * samples + i);
      const double wave = 0.6 * base::sin_cos_cycles(step * t).sin +
                          0.3 * base::sin_cos_cycles(3.1 * step * t).sin + 0.1 * noise;
      all[c][i] = level * static_cast<float>(wave);
    }
  }
  return all;
}

std::string hash_of(const Channels& channels) {
  base::Sha256 hash;
  for (const auto& channel : channels) hash.update(std::span<const float>(channel));
  return hash.finish_hex();
}

float loudest(const Channels& channels) {
  float most = 0;
  for (const auto& channel : channels) {
    for (const float sample : channel) {
      if (!std::isfinite(sample)) {
        ADD_FAILURE() << "not finite: " << sample;
        return sample;
      }
      most = std::max(most, std::abs(sample));
    }
  }
  return most;
}

void expect_same(const Channels& a, const Channels& b, const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (std::size_t c = 0; c < a.size(); ++c) {
    ASSERT_EQ(a[c].size(), b[c].size()) << what;
    for (std::size_t i = 0; i < a[c].size(); ++i) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(a[c][i]), std::bit_cast<std::uint32_t>(b[c][i]))
          << what << ": channel " << c << ", sample " << i << ": " << a[c][i] << " and " << b[c][i];
    }
  }
}

void expect_any_blocks_the_same(const std::function<std::unique_ptr<Plugin>()>& fresh,
                                const Channels& in, const std::vector<HostAction>& actions) {
  const auto rendered = [&](std::function<std::size_t()> block, bool in_place) {
    return play(*fresh(), in, {std::move(block), in_place, actions});
  };
  const Channels whole = rendered([&] { return in.front().size(); }, false);
  for (std::size_t size = 1; size <= 130; ++size) {
    expect_same(whole, rendered([size] { return size; }, size % 2 == 0),
                "blocks of " + std::to_string(size));
    if (testing::Test::HasFatalFailure()) return;
  }
  const base::RandomStream random{test_seed(), 0, 6102};
  for (const std::uint64_t most : {16, 300, 8192}) {
    std::uint64_t draw = most;
    expect_same(whole,
                rendered([&] { return 1 + static_cast<std::size_t>(random.bits(draw++) % most); },
                         most == 300),
                "blocks up to " + std::to_string(most));
  }
}

}  // namespace knotwave::support
