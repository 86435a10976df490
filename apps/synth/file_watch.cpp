// SPDX-License-Identifier: MIT
#include "file_watch.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <system_error>
#include <utility>

#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

namespace knotwave::synth {
namespace {

namespace fs = std::filesystem;
constexpr std::int64_t kQuietNs = 30'000'000;
constexpr std::int64_t kMostTouchedNs = 200'000'000;
constexpr std::int64_t kLookNs = 1'000'000'000;
constexpr std::int64_t kGoneNs = 500'000'000;
constexpr std::uint32_t kSaved = IN_CLOSE_WRITE | IN_MOVED_TO;

fs::path absolute(const std::string& path) {
  std::error_code failed;
  const fs::path whole = fs::absolute(path, failed).lexically_normal();
  return failed ? fs::path(path) : whole;
}

/// Where links lead; the path itself where it leads nowhere.
fs::path resolved(const fs::path& path) {
  std::error_code failed;
  const fs::path end = fs::weakly_canonical(path, failed);
  return failed ? path : end;
}

}  // namespace

bool FileWatch::Signature::operator==(const Signature& other) const {
  return size == other.size && saved.tv_sec == other.saved.tv_sec &&
         saved.tv_nsec == other.saved.tv_nsec && node == other.node;
}

FileWatch::FileWatch() : inotify_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {}

FileWatch::~FileWatch() {
  if (inotify_ >= 0) ::close(inotify_);
}

FileWatch::Signature FileWatch::signature_of(const std::string& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return {};
  return {info.st_size, info.st_mtim, info.st_ino};
}

void FileWatch::watch(const std::vector<std::string>& paths) {
  std::set<std::string> wanted;
  std::map<std::string, File> files;
  for (const std::string& path : paths) {
    // Both ends of a link: either may be saved.
    const fs::path whole = absolute(path);
    for (const fs::path& place : {whole, resolved(whole)}) {
      const std::string name = place.string();
      const auto known = files_.find(name);
      files[name] = known != files_.end() ? known->second : File{path, signature_of(name)};
      wanted.insert(place.parent_path().string());
    }
  }
  files_ = std::move(files);
  for (auto at = folders_.begin(); at != folders_.end();) {
    const bool is_kept = wanted.erase(at->second) > 0;
    if (!is_kept) ::inotify_rm_watch(inotify_, at->first);
    at = is_kept ? std::next(at) : folders_.erase(at);
  }
  for (const std::string& folder : wanted) {
    const int number = ::inotify_add_watch(inotify_, folder.c_str(), kSaved);
    if (number >= 0) folders_[number] = folder;
  }
}

bool FileWatch::read_events(bool any_in_folders) {
  alignas(inotify_event) char bytes[8192];
  bool is_ours = false;
  for (;;) {
    const ssize_t count = inotify_ < 0 ? -1 : ::read(inotify_, bytes, sizeof bytes);
    if (count <= 0) return is_ours;
    for (const char* at = bytes; at < bytes + count;) {
      const auto* event = reinterpret_cast<const inotify_event*>(at);
      at += sizeof(inotify_event) + event->len;
      const auto folder = folders_.find(event->wd);
      if (folder == folders_.end() || event->len == 0) continue;
      const std::string name = (fs::path(folder->second) / event->name).string();
      is_ours = is_ours || any_in_folders || files_.count(name) > 0;
    }
  }
}

bool FileWatch::look_at_files(std::int64_t now_ns) {
  bool is_changed = false;
  for (auto& [path, file] : files_) {
    const Signature now = signature_of(path);
    if (now.size < 0) {
      if (file.gone_ns < 0) file.gone_ns = now_ns;
      if (file.is_told_gone || now_ns - file.gone_ns < kGoneNs) continue;
      file.is_told_gone = true;
      note_presence(file.given, false);
      continue;
    }
    const bool is_back = std::exchange(file.gone_ns, -1) >= 0;
    if (std::exchange(file.is_told_gone, false)) note_presence(file.given, true);
    if (!is_back && now == file.known) continue;
    file.known = now;
    is_changed = true;
  }
  return is_changed;
}

/// Once, though both ends of a link go and come.
void FileWatch::note_presence(const std::string& path, bool is_there) {
  const bool is_noted = std::any_of(presence_.begin(), presence_.end(), [&](const Presence& p) {
    return p.path == path && p.is_there == is_there;
  });
  if (!is_noted) presence_.push_back({path, is_there});
}

std::vector<FileWatch::Presence> FileWatch::take_presence() { return std::exchange(presence_, {}); }

bool FileWatch::is_changed(std::int64_t now_ns, bool any_in_folders) {
  bool is_seen = read_events(any_in_folders);
  if (is_seen || now_ns - looked_ns_ >= kLookNs) {
    looked_ns_ = now_ns;
    is_seen = look_at_files(now_ns) || is_seen;
  }
  if (is_seen) {
    if (!is_touched_) first_touched_ns_ = now_ns;
    is_touched_ = true;
    touched_ns_ = now_ns;
  }
  if (!is_touched_) return false;
  // Who saves without a pause is heard as well.
  const bool is_quiet = now_ns - touched_ns_ >= kQuietNs;
  if (!is_quiet && now_ns - first_touched_ns_ < kMostTouchedNs) return false;
  is_touched_ = false;
  return true;
}

}  // namespace knotwave::synth
