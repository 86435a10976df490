// SPDX-License-Identifier: MIT
#include "env_process.h"

#include <fstream>
#include <iterator>

namespace knotwave::io {

EnvProcess::EnvProcess(const std::string& patch, std::vector<std::string> words) {
  std::ofstream(folder_.file("patch.toml")) << patch;
  words.insert(words.begin(),
               {std::string(KNOTWAVE_BIN_DIR) + "/knotwave-env", folder_.file("patch.toml")});
  program_ = std::make_unique<support::BackgroundProgram>(words, folder_.file("log"));
}

std::string EnvProcess::log() const {
  std::ifstream file(folder_.file("log"));
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace knotwave::io
