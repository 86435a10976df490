// SPDX-License-Identifier: MIT
// What a synth hands to itself when it has to be started anew: PortAudio that hung when its device
// vanished cannot be used again in the same process.
#pragma once
#include <string>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/engine/live_message.h"

namespace knotwave::synth {

struct Resume {
  std::string patch;      ///< empty: as the command line says
  std::string demo_file;  ///< of the demo's folder, which is another one by now; goes before patch
  int program_entry = 0;  ///< of the bank, which tab chose last
  double song_s = -1;     ///< how far the song is; negative: none is played
  int takes = 0;          ///< that were begun
  std::string api;        ///< of the device that was lost; empty: a first start
  double rate_hz = 0;     ///< of the engine
  std::vector<engine::LiveMessage> held;

  bool is_first_start() const { return api.empty(); }
};

/// From the environment, where leave_resume() leaves it. What is no number there counts as missing.
Resume take_resume();
void leave_resume(const Resume& resume);

/// Becomes this program again, with the same words. Returns only where that failed; the error then
/// says why.
Error restart_program(const Resume& resume, char** argv);

}  // namespace knotwave::synth
