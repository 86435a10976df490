// SPDX-License-Identifier: MIT
// What comes in by OSC, handed to the engine at once and to the program at its next turn.
#pragma once
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "knotwave/engine/patch.h"
#include "knotwave/io/osc_input.h"

#include "engine_gate.h"
#include "osc_map.h"
#include "status.h"

namespace knotwave::synth {

class OscDoor final : private io::OscListener {
 public:
  /// Errors: those of OscInput::open(). `gate` must outlive it.
  static Result<std::unique_ptr<OscDoor>> open(const io::OscPlace& place, EngineGate& gate);
  ~OscDoor() override;

  /// Whose targets `/target/NAME` means.
  void follow(std::shared_ptr<const engine::PatchSpec> patch);

  struct Wishes {
    bool panic = false;
    std::string patch;               ///< to be loaded; empty: none
    std::vector<std::string> lines;  ///< worth telling
  };
  /// What came since the last call.
  Wishes take();
  void describe(SynthStatus& status) const;

 private:
  OscDoor(EngineGate& gate, std::string place) : gate_(gate), place_(std::move(place)) {}
  void message(std::string_view address, std::span<const io::OscArgument> arguments,
               std::int64_t time_ns) noexcept override;

  EngineGate& gate_;
  std::string place_;
  mutable std::mutex mutex_;
  std::shared_ptr<const engine::PatchSpec> patch_;
  OscFaults faults_;
  Wishes wishes_;
  std::unique_ptr<io::OscInput> input_;
};

}  // namespace knotwave::synth
