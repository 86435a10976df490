// SPDX-License-Identifier: MIT
#include "demo/demo.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "knotwave/base/suggest.h"

namespace knotwave::demo {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kScores = "scores/";
constexpr std::string_view kScoreEnding = ".mid";

bool is_embedded(const std::string& name) {
  const auto files = embedded_files();
  return std::any_of(files.begin(), files.end(),
                     [&](const EmbeddedFile& file) { return file.name == name; });
}

std::string patch_of(const std::string& demo) {
  for (const std::string& name : {"banks/" + demo + ".toml", "patches/" + demo + ".toml"}) {
    if (is_embedded(name)) return name;
  }
  return "banks/general-midi.toml";
}

Result<void> write_below(const fs::path& folder, const EmbeddedFile& file) {
  const fs::path path = folder / file.name;
  std::error_code code;
  fs::create_directories(path.parent_path(), code);
  if (code) return fail(ErrorCode::io_failed, path.string() + ": " + code.message());
  // Not base::write_file(): these files need not outlive a power cut, and syncing them takes time.
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(file.bytes.data()),
            static_cast<std::streamsize>(file.bytes.size()));
  if (!out.flush()) return fail(ErrorCode::io_failed, "cannot write '" + path.string() + "'");
  return {};
}

}  // namespace

std::vector<std::string> names_of_demos() {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : embedded_files()) {
    if (!file.name.starts_with(kScores) || !file.name.ends_with(kScoreEnding)) continue;
    const std::size_t size = file.name.size() - kScores.size() - kScoreEnding.size();
    names.emplace_back(file.name.substr(kScores.size(), size));
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool is_demo(const std::string& name) {
  const auto demos = names_of_demos();
  return std::find(demos.begin(), demos.end(), name) != demos.end();
}

Error unknown_demo(const std::string& name) {
  const auto demos = names_of_demos();
  const std::vector<std::string_view> known(demos.begin(), demos.end());
  std::string list;
  for (const auto& demo : demos) list += (list.empty() ? "" : ", ") + demo;
  return fail(
      ErrorCode::unknown_name,
      "there is no demo '" + name + "'" + base::suggestion(name, known) + " (demos: " + list + ")");
}

Result<DemoFiles> DemoFiles::unpack(const std::string& name) {
  if (!is_demo(name)) return unknown_demo(name);
  std::error_code code;
  std::string pattern = (fs::temp_directory_path(code) / "knotwave-demo-XXXXXX").string();
  if (code || ::mkdtemp(pattern.data()) == nullptr) {
    return fail(ErrorCode::io_failed, "cannot make a folder '" + pattern + "' for the demo: " +
                                          std::generic_category().message(errno));
  }
  DemoFiles demo;
  demo.folder_ = pattern;
  demo.patch_ = patch_of(name);
  demo.score_ = std::string(kScores) + name + std::string(kScoreEnding);
  for (const EmbeddedFile& file : embedded_files()) {
    const bool is_other_score = file.name.starts_with(kScores) && file.name != demo.score_;
    if (is_other_score) continue;
    if (auto written = write_below(demo.folder_, file); !written) return written.error();
  }
  return demo;
}

DemoFiles::DemoFiles(DemoFiles&& other) noexcept
    : folder_(std::exchange(other.folder_, {})),
      patch_(std::move(other.patch_)),
      score_(std::move(other.score_)) {}

DemoFiles::~DemoFiles() {
  std::error_code ignored;  // a temporary folder that cannot be removed harms nothing
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

}  // namespace knotwave::demo
