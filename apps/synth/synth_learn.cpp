// SPDX-License-Identifier: MIT
// Knobs that are learnt, and which names OSC knows: what follows from the patch that plays.
#include <algorithm>
#include <filesystem>
#include <system_error>

#include "knotwave/base/file.h"

#include "synth.h"

namespace knotwave::synth {
namespace {

/// The controllers that a bank's maps listen to, each once.
std::vector<int> controllers_of(const engine::BankSpec& bank) {
  std::vector<int> controllers;
  for (const engine::PatchSpec& patch : bank.patches) {
    for (const engine::MapSpec& map : patch.maps) {
      if (map.source == engine::MapSource::control) controllers.push_back(map.source_index);
      if (map.source_v == engine::MapSource::control) controllers.push_back(map.source_v_index);
    }
  }
  std::sort(controllers.begin(), controllers.end());
  controllers.erase(std::unique(controllers.begin(), controllers.end()), controllers.end());
  std::erase_if(controllers, [](int controller) { return !engine::is_learnable(controller); });
  return controllers;
}

}  // namespace

/// A file that is not there yet is made when something is learnt.
Result<void> Synth::open_learn() {
  if (options_.midi_learn.empty()) return {};
  engine::LearnSpec spec;
  std::error_code failed;
  if (std::filesystem::exists(options_.midi_learn, failed)) {
    auto read = engine::read_midi_learn(options_.midi_learn);
    if (!read) return read.error();
    spec = *std::move(read);
  }
  auto learn = engine::MidiLearn::create(spec);
  if (!learn) return learn.error();
  player_->entry().use(*std::move(learn));
  return {};
}

/// One controller of the patch after another, then none.
void Synth::learn_next() {
  if (options_.midi_learn.empty()) {
    return tell("learning needs a file to keep it in: start with --midi-learn FILE");
  }
  const std::vector<int> controllers = controllers_of(player_->bank());
  if (controllers.empty()) return tell("this patch listens to no controller that can be learnt");
  if (next_controller_ >= controllers.size()) {
    next_controller_ = 0;
    player_->entry().cancel();
    return tell("learning is over");
  }
  const int controller = controllers[next_controller_++];
  if (!player_->entry().learn(controller)) return tell("no more than 128 knobs can be learnt");
  tell("move a knob: it will stand for the patch's controller " + std::to_string(controller) +
       " (m: " + (next_controller_ < controllers.size() ? "the next one)" : "none)"));
}

void Synth::follow_learn() {
  const auto spec = player_->entry().news();
  if (!spec) return;
  const auto written = base::write_file(options_.midi_learn, engine::write_midi_learn(*spec));
  if (!written) return tell("not kept: " + written.error().to_string());
  const auto& knob = spec->knobs.back();
  tell("controller " + std::to_string(knob.from) + " stands for " + std::to_string(knob.to) +
       " now; kept in " + options_.midi_learn);
}

void Synth::follow_targets(std::size_t patch) {
  if (!osc_) return;
  const auto& patches = player_->bank().patches;
  if (patch < patches.size()) {
    osc_->follow(std::make_shared<const engine::PatchSpec>(patches[patch]));
  }
}

}  // namespace knotwave::synth
