// SPDX-License-Identifier: MIT
#include "missing_patches.h"

#include <vector>

#include "song/event_feed.h"

namespace knotwave::render {
namespace {

std::string name_of(const engine::MissingPatch& missing) {
  const std::string channel = " (channel " + std::to_string(missing.channel + 1) + ")";
  if (missing.key >= 0) return "drum key " + std::to_string(missing.key) + channel;
  return "program " + std::to_string(missing.program) + " of bank " +
         std::to_string(missing.bank_msb) + ":" + std::to_string(missing.bank_lsb) + channel;
}

}  // namespace

std::string missing_patches(const engine::EngineCounters& counters) {
  if (counters.notes_without_patch == 0) return "";
  std::string names;
  for (int i = 0; i < counters.missing_count; ++i) {
    names += (i == 0 ? "" : ", ") + name_of(counters.missing[static_cast<std::size_t>(i)]);
  }
  const bool is_full = counters.missing_count == engine::EngineCounters::kMissingNamed;
  return std::to_string(counters.notes_without_patch) +
         (counters.notes_without_patch == 1 ? " note is" : " notes are") +
         " silent: the bank has no patch for " + names + (is_full ? " and maybe more" : "") +
         "; numbers count from 0";
}

std::string find_missing_patches(const RenderInput& input) {
  const auto engine = engine::Engine::create({.max_voices = 1}, input.bank.get());
  if (!engine) return "";
  // Which patch a note finds depends on the order of messages alone, so they need no time; and what
  // is given with a block of no samples is played at once.
  constexpr std::size_t kAtOnce = 1024;
  std::vector<engine::Event> block;
  for (std::size_t i = 0; i < input.song.events.size(); ++i) {
    block.push_back(song::engine_event(input.song, input.song.events[i]));
    if (block.size() < kAtOnce && i + 1 < input.song.events.size()) continue;
    (*engine)->process(block, {}, {});
    block.clear();
  }
  return missing_patches((*engine)->counters());
}

}  // namespace knotwave::render
