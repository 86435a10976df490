// SPDX-License-Identifier: MIT
// knotwave-env in the background, with a patch of the test's own.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "support/background_program.h"
#include "support/program.h"

namespace knotwave::io {

class EnvProcess {
 public:
  EnvProcess(const std::string& patch, std::vector<std::string> words);
  support::BackgroundProgram& program() { return *program_; }
  /// All that it said.
  std::string log() const;

 private:
  support::ScratchFolder folder_;
  std::unique_ptr<support::BackgroundProgram> program_;
};

}  // namespace knotwave::io
