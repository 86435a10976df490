// SPDX-License-Identifier: MIT
#include "osc_door.h"

#include <utility>

#include "knotwave/engine/target_words.h"

namespace knotwave::synth {

Result<std::unique_ptr<OscDoor>> OscDoor::open(const io::OscPlace& place, EngineGate& gate) {
  const std::string name = place.host + ":" + std::to_string(place.port);
  std::unique_ptr<OscDoor> door(new OscDoor(gate, name));
  auto input = io::OscInput::open(place, *door);
  if (!input) return input.error();
  door->input_ = *std::move(input);
  return door;
}

OscDoor::~OscDoor() { input_.reset(); }

void OscDoor::follow(std::shared_ptr<const engine::PatchSpec> patch) {
  const std::lock_guard lock(mutex_);
  patch_ = std::move(patch);
}

void OscDoor::message(std::string_view address, std::span<const io::OscArgument> arguments,
                      std::int64_t time_ns) noexcept {
  const std::lock_guard lock(mutex_);
  const auto target = [this](std::string_view name) -> Result<std::uint16_t> {
    if (!patch_) return fail(ErrorCode::unknown_name, "no patch plays");
    const auto slot = engine::find_slot(*patch_, name);
    if (!slot) return slot.error();
    return static_cast<std::uint16_t>(*slot);
  };
  auto command = osc_command(address, arguments, time_ns, target);
  if (!command) {
    if (auto line = faults_.told_once(address, command.error())) wishes_.lines.push_back(*line);
    return;
  }
  if (const auto* played = std::get_if<engine::LiveMessage>(&*command)) {
    gate_.push(kNetworkInput, *played);
  } else if (auto* patch = std::get_if<OscPatch>(&*command)) {
    wishes_.patch = std::move(patch->path);
  } else {
    wishes_.panic = true;
  }
}

OscDoor::Wishes OscDoor::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(wishes_, {});
}

void OscDoor::describe(SynthStatus& status) const {
  const std::lock_guard lock(mutex_);
  status.osc = place_;
  status.osc_messages = input_->messages();
  status.osc_faults = input_->faults() + faults_.count();
}

}  // namespace knotwave::synth
