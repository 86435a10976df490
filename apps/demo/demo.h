// SPDX-License-Identifier: MIT
// The demos inside the program: a score of examples/scores/ with the bank or patch of its name, or
// with the General MIDI bank.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/base/result.h"

namespace knotwave::demo {

struct EmbeddedFile {
  std::string_view name;  ///< below examples/
  std::span<const unsigned char> bytes;
};
/// Every file of the examples that a demo may need. Made at build time.
std::span<const EmbeddedFile> embedded_files();

/// By name.
std::vector<std::string> names_of_demos();
bool is_demo(const std::string& name);
/// unknown_name, with a suggestion and the list.
Error unknown_demo(const std::string& name);

/// A demo laid out as files in a folder of its own, which goes with the object: patches name each
/// other by path.
class DemoFiles {
 public:
  /// Errors: unknown_name, io_failed.
  static Result<DemoFiles> unpack(const std::string& name);
  DemoFiles(DemoFiles&& other) noexcept;
  DemoFiles& operator=(DemoFiles&&) = delete;
  ~DemoFiles();

  const std::string& folder() const { return folder_; }
  std::string patch() const { return folder_ + "/" + patch_; }
  std::string score() const { return folder_ + "/" + score_; }

 private:
  DemoFiles() = default;
  std::string folder_, patch_, score_;
};

}  // namespace knotwave::demo
