// SPDX-License-Identifier: MIT
// The instrument through the tests' LV2 and VST3 hosts. What the hosts themselves do is left out by
// callgrind's --toggle-collect (bench/results/plugins.md).
#include <limits>
#include <string>

#include "knotwave/plugins/instrument.h"

#include "lv2_host.h"
#include "plugin_cost.h"
#include "plugin_cost_told.h"
#include "vst3_host.h"

namespace knotwave::bench {
namespace {

test::Story story_of(int block) {
  const Told told = told_in(block);
  test::Story story;
  story.frames = kBlock;
  for (const auto& bytes : told.midi) story.midi.push_back({0, bytes});
  const plugins::ParameterTable& table = plugins::Instrument::table();
  const std::size_t place = table.of_word("cutoff");
  const plugins::Parameter& cutoff = table[place];
  if (told.moves) {
    story.points.push_back({0, place, (told.cutoff - cutoff.low) / (cutoff.high - cutoff.low)});
  }
  return story;
}

}  // namespace

double by_host(std::string_view way, int blocks) {
  double sum = 0;
  if (way == "lv2") {
    test::Lv2Plugin plugin(plugins::instrument_info(), KNOTWAVE_LV2_FILE, kRate);
    plugin.activate();
    for (int block = 0; block < blocks; ++block) {
      sum += static_cast<double>(plugin.run(story_of(block))[0][0]);
    }
    return sum;
  }
  if (way == "vst3") {
    const test::Vst3Module module(KNOTWAVE_VST3_FOLDER);
    test::Vst3Plugin plugin(module);
    plugin.start(kRate, kBlock);
    for (int block = 0; block < blocks; ++block) {
      sum += static_cast<double>(plugin.process(story_of(block))[0][0]);
    }
    return sum;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace knotwave::bench
