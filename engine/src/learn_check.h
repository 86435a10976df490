// SPDX-License-Identifier: MIT
// What is wrong with a set of learnt knobs, and which of them has it. [control]
#pragma once
#include <optional>

#include "knotwave/engine/midi_learn.h"

namespace knotwave::engine {

struct LearnFault {
  std::size_t knob = 0;
  const char* key = "";  ///< of the knob's table
  Error error;
};
std::optional<LearnFault> learn_fault(const LearnSpec& spec);

}  // namespace knotwave::engine
