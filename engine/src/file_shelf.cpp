// SPDX-License-Identifier: MIT
// The files that patches and banks name.
#include <algorithm>
#include <filesystem>

#include "knotwave/base/file.h"

#include "patch_tables.h"

namespace knotwave::engine {
namespace fs = std::filesystem;

std::string FileShelf::beside(const std::string& from, const std::string& name) {
  return (fs::path(from).parent_path() / name).lexically_normal().string();
}

std::string FileShelf::canonical(const std::string& path) const {
  if (from_texts_) return fs::path(path).lexically_normal().string();
  std::error_code failed;
  const fs::path found = fs::weakly_canonical(path, failed);
  return failed ? path : found.string();
}

Result<std::string> FileShelf::read(const std::string& path) {
  const auto link = std::find(chain_.begin(), chain_.end(), canonical(path));
  if (link != chain_.end()) {
    return fail(ErrorCode::cyclic_reference,
                "'" + path + "' is being read already: " +
                    (link == chain_.end() - 1 ? "a file may not name itself"
                                              : "files may not name each other in a circle"));
  }
  paths_.push_back(path);
  auto text = read_first(path);
  if (text) return text;
  return fail(text.error().code, "'" + path + "': " + text.error().message);
}

Result<std::string> FileShelf::read_first(const std::string& path) {
  auto text = from_texts_ ? given_text(path) : base::read_file(path, base::kMaxDocumentBytes);
  const bool is_kept = std::any_of(texts_.begin(), texts_.end(),
                                   [&](const FileText& file) { return file.path == path; });
  if (text && !is_kept) texts_.push_back({path, *text});
  return text;
}

Result<std::string> FileShelf::given_text(const std::string& path) const {
  const auto given = std::find_if(given_.begin(), given_.end(),
                                  [&](const FileText& file) { return file.path == path; });
  if (given == given_.end()) {
    Error error = fail(ErrorCode::file_not_found, "is not among the files that were kept");
    error.source = path;
    return error;
  }
  return given->bytes;
}

Result<const curves::CurveSet*> FileShelf::curves(const std::string& path) {
  const std::string key = canonical(path);
  if (const auto known = curve_files_.find(key); known != curve_files_.end()) {
    return &known->second;
  }
  auto text = read(path);
  if (!text) return text.error();
  auto set = curves::parse_curves(*text, path);
  if (!set) return set.error();
  return &curve_files_.emplace(key, std::move(*set)).first->second;
}

}  // namespace knotwave::engine
