// SPDX-License-Identifier: MIT
#include "patch_watch.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "knotwave/base/document.h"
#include "knotwave/base/file.h"
#include "knotwave/curves/curve_file.h"

namespace knotwave::synth {
namespace {

namespace fs = std::filesystem;

bool is_patch(const std::string& path) {
  const auto text = base::read_file(path, base::kMaxDocumentBytes);
  if (!text) return false;
  const auto root = base::parse_document(*text, path);
  if (!root) return false;
  const auto kind = curves::read_file_kind(*root, path);
  return kind && *kind == curves::FileKind::patch;
}

/// Of the folder a file is in, sorted, those behind the file first.
std::vector<std::string> neighbours(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::vector<std::string> names;
  std::error_code failed;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    if (at->path().extension() == ".toml") names.push_back(at->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  std::rotate(names.begin(), std::upper_bound(names.begin(), names.end(), file.filename().string()),
              names.end());
  return names;
}

}  // namespace

PatchWatch::PatchWatch(const PlayableBank& bank) : path_(bank.path), tried_(bank.path) {
  files_.watch(files_of(bank));
}

PatchWatch::News PatchWatch::poll(std::int64_t now_ns) {
  // While it is broken, the file that heals it may be one it does not name yet.
  if (files_.is_changed(now_ns, is_broken_) && !is_trying_) loader_.request(path_);
  News news;
  for (const FileWatch::Presence& file : files_.take_presence()) {
    news.lines.push_back(file.path +
                         (file.is_there ? " is there again" : " is gone; the old sound plays on"));
  }
  auto loaded = loader_.take();
  if (!loaded) return news;
  if (loaded->path == tried_) is_trying_ = false;
  if (loaded->bank) {
    path_ = loaded->path;
    installed(std::move(loaded->bank).value(), news);
    return news;
  }
  const bool is_other = loaded->path != path_;
  Error error = std::move(loaded->bank).error();
  if (error.source.empty()) error.source = loaded->path;
  is_broken_ = is_broken_ || !is_other;
  news.lines.push_back(error.to_string());
  news.lines.push_back((is_other ? path_ : "the old sound") + " plays on");
  return news;
}

void PatchWatch::installed(PlayableBank bank, News& news) {
  news.lines.insert(news.lines.end(), bank.input.warnings.begin(), bank.input.warnings.end());
  news.lines.push_back("now playing " + path_);
  is_broken_ = false;
  files_.watch(files_of(bank));
  news.bank = std::move(bank);
}

void PatchWatch::load(const std::string& path) {
  tried_ = path;
  is_trying_ = true;
  loader_.request(path);
}

std::optional<std::string> PatchWatch::next_in_folder() const {
  const fs::path here(tried_);
  for (const std::string& name : neighbours(here)) {
    const std::string path = here.has_parent_path() ? (here.parent_path() / name).string() : name;
    if (path != tried_ && is_patch(path)) return path;
  }
  return std::nullopt;
}

}  // namespace knotwave::synth
