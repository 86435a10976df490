// SPDX-License-Identifier: MIT
// Keeps a program from writing over what it reads, or twice into one file.
#pragma once
#include <span>
#include <string>

namespace knotwave::command_line {

/// A file and what it is to the user: {"--json", "a.json"}, {"the score", "a.mid"}.
struct NamedFile {
  std::string role;
  std::string path;  ///< of an input, "-" is standard input
};

/// What is wrong when an output is a file that is read, or another output; empty when nothing is.
/// One file has many names: files are compared by device and inode, and those that are not there
/// yet by their place with every link followed.
std::string overlap(std::span<const NamedFile> inputs, std::span<const NamedFile> outputs);

}  // namespace knotwave::command_line
