// SPDX-License-Identifier: MIT
#include "knotwave/plugins/plugin.h"

#include "knotwave/base/file.h"

namespace knotwave::plugins {

Result<void> Plugin::load_file(const std::string& path) {
  constexpr std::size_t kMostBytes = 64 << 20;
  const auto text = base::read_file(path, kMostBytes);
  if (!text) return text.error();
  return load_state(*text);
}

}  // namespace knotwave::plugins
