// SPDX-License-Identifier: MIT
// A host for effects: plays a whole piece through a plugin in blocks of chosen sizes, with what is
// set at its samples.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "knotwave/plugins/plugin.h"

namespace knotwave::support {

using Channels = std::vector<std::vector<float>>;

/// What a host does at a sample of the piece. `offset` counts from the block's first sample.
struct HostAction {
  std::int64_t sample = 0;
  std::function<void(plugins::Plugin& plugin, std::int64_t offset)> act;
};
HostAction set_at(std::int64_t sample, std::size_t place, double value);
HostAction transport_at(std::int64_t sample, const plugins::Transport& transport);

struct HostRun {
  std::function<std::size_t()> block = [] { return std::size_t{64}; };  ///< the next one's size
  bool in_place = false;
  std::vector<HostAction> actions = {};  ///< in order of samples
};

/// What comes out of an active plugin. Actions are played at their own samples.
Channels play(plugins::Plugin& plugin, const Channels& in, const HostRun& run = {});

/// The plugin, active at 48 kHz, with parameters set before: {{word, text}}.
using Settings = std::vector<std::pair<std::string, std::string>>;
std::unique_ptr<plugins::Plugin> active(const plugins::PluginInfo& info,
                                        const Settings& settings = {}, double rate_hz = 48000);
void set(plugins::Plugin& plugin, const Settings& settings);
std::size_t place_of(const plugins::PluginInfo& info, const std::string& word);

/// Sums of sines and a little noise below `level`, different in every channel, the same everywhere.
Channels music(std::size_t channels, std::size_t samples, float level = 1);
/// SHA-256 of all channels one after the other.
std::string hash_of(const Channels& channels);
/// The largest |sample|; NaN and infinity are reported as failures of the test.
float loudest(const Channels& channels);
/// Equal to the bit; the first difference is a failure of the test.
void expect_same(const Channels& a, const Channels& b, const std::string& what);
/// The same piece in one block, in blocks of 1 to 130, of 8192 and of random sizes, in place and
/// not: the same bits. `fresh` makes the plugin as it begins.
void expect_any_blocks_the_same(const std::function<std::unique_ptr<plugins::Plugin>()>& fresh,
                                const Channels& in, const std::vector<HostAction>& actions);

}  // namespace knotwave::support
