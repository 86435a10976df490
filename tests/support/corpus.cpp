// SPDX-License-Identifier: MIT
#include "support/corpus.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace knotwave::support {
namespace fs = std::filesystem;

std::string corpus_root() {
  const char* root = std::getenv("KNOTWAVE_CORPUS");
  return root != nullptr && fs::is_directory(root) ? root : "";
}

std::vector<std::string> corpus_files(const std::string& sub,
                                      const std::vector<std::string>& extensions) {
  std::vector<std::string> files;
  const fs::path folder = fs::path(corpus_root()) / sub;
  if (corpus_root().empty() || !fs::is_directory(folder)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (entry.is_regular_file() &&
        std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) {
      files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace knotwave::support
