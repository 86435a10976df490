// SPDX-License-Identifier: MIT
// Files of examples/ as they are, by cmake/EmbedFiles.cmake.
#pragma once
#include <span>
#include <string_view>

namespace knotwave::plugins {

struct EmbeddedFile {
  std::string_view name;  ///< below examples/
  std::span<const unsigned char> bytes;
};
std::span<const EmbeddedFile> embedded_files();

}  // namespace knotwave::plugins
