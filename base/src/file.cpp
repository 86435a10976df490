// SPDX-License-Identifier: MIT
// Reading and writing of whole files through POSIX calls, every result checked.
#include "knotwave/base/file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <system_error>
#include <vector>

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "knotwave/base/sha256.h"
#include "knotwave/base/suggest.h"

#include "unfinished_files.h"

namespace knotwave::base {
namespace {

constexpr std::string_view kPartMark = ".part-";
constexpr std::size_t kMaxNameBytes = 255;     ///< of the file systems we write to
constexpr std::size_t kMaxProcessDigits = 10;  ///< of a pid_t

Error system_error(int number, const std::string& what) {
  const bool full = number == ENOSPC || number == EDQUOT;
  return fail(full ? ErrorCode::disk_full : ErrorCode::io_failed,
              what + ": " + std::generic_category().message(number));
}

Error read_error(ErrorCode code, const std::string& path, std::string message) {
  Error error = fail(code, std::move(message));
  error.source = path;
  return error;
}

/// A descriptor closed on the way out.
struct Descriptor {
  int value = -1;
  explicit Descriptor(int descriptor) : value(descriptor) {}
  ~Descriptor() {
    if (value >= 0) ::close(value);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
};

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

std::string name_of(const std::string& path) { return path.substr(path.rfind('/') + 1); }

/// More entries are not looked at: a suggestion is not worth a long wait.
constexpr int kMaxEntries = 4096;

/// `; did you mean 'folder/name'?` for a path that names nothing: the same name with an ending, or
/// the nearest name in its folder. Empty without one.
std::string nearest_file(const std::string& path) {
  const std::string name = name_of(path);
  const std::unique_ptr<DIR, int (*)(DIR*)> stream(::opendir(folder_of(path).c_str()), ::closedir);
  if (!stream || name.empty()) return {};
  std::vector<std::string> names;
  for (int i = 0; i < kMaxEntries; ++i) {
    const dirent* entry = ::readdir(stream.get());
    if (entry == nullptr) break;
    if (entry->d_name[0] != '.') names.emplace_back(entry->d_name);
  }
  std::sort(names.begin(), names.end());  // the order of a folder is the file system's
  const std::vector<std::string_view> known(names.begin(), names.end());
  const auto with_ending = std::find_if(known.begin(), known.end(), [&](std::string_view entry) {
    return entry.starts_with(name + '.');
  });
  const std::string_view nearest =
      with_ending != known.end() ? *with_ending : nearest_word(name, known);
  if (nearest.empty()) return {};
  const std::string folder = path.substr(0, path.size() - name.size());
  return "; did you mean '" + folder + std::string(nearest) + "'?";
}

/// What stands before the mark in the name of a part: the name, or as much of it as fits with a
/// hash that tells it from its like.
std::string part_stem(const std::string& name) {
  constexpr std::size_t kMost = kMaxNameBytes - kPartMark.size() - kMaxProcessDigits;
  if (name.size() <= kMost) return name;
  constexpr std::size_t kHashDigits = 16;
  Sha256 hash;
  hash.update(std::as_bytes(std::span(name)));
  std::size_t kept = kMost - kHashDigits - 1;
  while (kept > 0 && (name[kept] & 0xC0) == 0x80) --kept;  // no UTF-8 letter is cut
  return name.substr(0, kept) + '-' + hash.finish_hex().substr(0, kHashDigits);
}

/// The process id at the end of `entry` if it is NAME.part-PID, else 0.
pid_t part_owner(std::string_view entry, std::string_view name) {
  if (!entry.starts_with(name)) return 0;
  entry.remove_prefix(name.size());
  if (!entry.starts_with(kPartMark)) return 0;
  entry.remove_prefix(kPartMark.size());
  pid_t owner = 0;
  const auto [end, code] = std::from_chars(entry.data(), entry.data() + entry.size(), owner);
  return code == std::errc{} && end == entry.data() + entry.size() ? owner : 0;
}

/// A process id says little across containers that share a folder, so the writer's lock counts too.
bool is_abandoned(const std::string& part_path, pid_t owner) {
  if (owner == ::getpid()) return !is_unfinished_here(part_path);
  if (::kill(owner, 0) == 0 || errno != ESRCH) return false;
  const Descriptor part(::open(part_path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW));
  return part.value >= 0 && ::flock(part.value, LOCK_EX | LOCK_NB) == 0;
}

void sweep_abandoned_parts(const std::string& path) {
  const std::string folder = folder_of(path);
  const std::string name = name_of(path);
  const std::string stem = part_stem(name);
  const std::unique_ptr<DIR, int (*)(DIR*)> stream(::opendir(folder.c_str()), ::closedir);
  if (!stream) return;
  while (const dirent* entry = ::readdir(stream.get())) {
    const pid_t owner = part_owner(entry->d_name, stem);
    const std::string part_path = path.substr(0, path.size() - name.size()) + entry->d_name;
    if (owner > 0 && is_abandoned(part_path, owner)) ::unlink(part_path.c_str());
  }
}

/// The place a link points to, so that writing replaces the file and not the link.
Result<std::string> final_place(const std::string& path) {
  struct stat info {};
  if (::lstat(path.c_str(), &info) != 0) return path;
  if (!S_ISLNK(info.st_mode)) return path;
  const std::unique_ptr<char, void (*)(void*)> resolved(::realpath(path.c_str(), nullptr),
                                                        std::free);
  if (!resolved) return system_error(errno, "cannot follow the link '" + path + "'");
  return std::string(resolved.get());
}

Result<void> write_all(int descriptor, std::span<const std::byte> bytes, const std::string& path) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_error(errno, "cannot write '" + path + "'");
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return {};
}

/// Of a pipe or a terminal: there is something to read, or its end.
bool has_more(int descriptor) {
  constexpr int kPatienceMs = 5000;
  pollfd ready{descriptor, POLLIN, 0};
  int count = 0;
  do {
    count = ::poll(&ready, 1, kPatienceMs);
  } while (count < 0 && errno == EINTR);
  return count > 0;
}

}  // namespace

Result<std::string> read_file(const std::string& path, std::size_t max_bytes) {
  // A pipe without a writer would be waited for in open().
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.value < 0) {
    const bool missing = errno == ENOENT || errno == ENOTDIR;
    return read_error(
        missing ? ErrorCode::file_not_found : ErrorCode::io_failed, path,
        missing ? "no such file" + nearest_file(path) : std::generic_category().message(errno));
  }
  struct stat info {};
  if (::fstat(file.value, &info) == 0 && S_ISDIR(info.st_mode)) {
    return read_error(ErrorCode::io_failed, path, "is a folder, not a file");
  }
  const auto too_large = [&](const std::string& size) {
    return read_error(
        ErrorCode::file_too_large, path,
        "the file has " + size + " bytes; at most " + std::to_string(max_bytes) + " are read");
  };
  if (S_ISREG(info.st_mode) && static_cast<std::uintmax_t>(info.st_size) > max_bytes) {
    return too_large(std::to_string(info.st_size));
  }
  std::string bytes;
  for (;;) {
    if (!S_ISREG(info.st_mode) && !has_more(file.value)) {
      return read_error(ErrorCode::io_failed, path, "nobody has written into this pipe for 5 s");
    }
    constexpr std::size_t kChunk = 1 << 16;
    const std::size_t before = bytes.size();
    bytes.resize(before + kChunk);
    const ssize_t count = ::read(file.value, bytes.data() + before, kChunk);
    if (count < 0 && errno != EINTR && errno != EAGAIN) {
      return read_error(ErrorCode::io_failed, path, std::generic_category().message(errno));
    }
    bytes.resize(before + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (bytes.size() > max_bytes) return too_large("more than " + std::to_string(max_bytes));
    if (count == 0) return bytes;
  }
}

Result<AtomicFile> AtomicFile::create(const std::string& path) {
  const Result<std::string> place = final_place(path);
  if (!place) return place.error();
  AtomicFile file;
  file.path_ = *place;
  struct stat old {};
  const bool exists = ::stat(file.path_.c_str(), &old) == 0;
  if (!exists && errno == ENAMETOOLONG) return system_error(errno, "cannot write '" + path + "'");
  if (file.path_.empty() || file.path_.back() == '/' || (exists && S_ISDIR(old.st_mode))) {
    return fail(ErrorCode::io_failed, "cannot write '" + path + "': it is a folder, not a file");
  }
  if (exists && !S_ISREG(old.st_mode)) {
    return fail(ErrorCode::io_failed,
                "cannot write '" + path + "': it is a device or pipe, not a file");
  }
  sweep_abandoned_parts(file.path_);
  const std::string name = name_of(file.path_);
  const std::string part_path = file.path_.substr(0, file.path_.size() - name.size()) +
                                part_stem(name) + std::string(kPartMark) +
                                std::to_string(::getpid());
  if (is_unfinished_here(part_path)) {
    return fail(ErrorCode::io_failed, "cannot write '" + path + "': it is being written already");
  }
  file.slot_ = note_unfinished_file(part_path);
  if (file.slot_ < 0) {
    return fail(ErrorCode::io_failed, "cannot write '" + path + "': more than " +
                                          std::to_string(kMaxUnfinishedFiles) +
                                          " files at once, or a path over 4095 bytes");
  }
  file.descriptor_ =
      ::open(part_path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file.descriptor_ < 0) {
    return system_error(errno, "cannot write into folder '" + folder_of(file.path_) + "'");
  }
  file.part_path_ = part_path;
  ::flock(file.descriptor_, LOCK_EX | LOCK_NB);  // tells sweepers that the writer lives
  if (exists) ::fchmod(file.descriptor_, old.st_mode & 07777);
  return file;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept { *this = std::move(other); }

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(part_path_, other.part_path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(slot_, other.slot_);
  return *this;
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) {
    ::unlink(part_path_.c_str());
    ::close(descriptor_);
  }
  forget_unfinished_file(slot_);
}

Result<void> AtomicFile::write(std::span<const std::byte> bytes) {
  KNOTWAVE_ASSERT(descriptor_ >= 0);
  return write_all(descriptor_, bytes, path_);
}

Result<void> AtomicFile::commit() {
  KNOTWAVE_ASSERT(descriptor_ >= 0);
  const std::string what = "cannot write '" + path_ + "'";
  if (::fsync(descriptor_) != 0) return system_error(errno, what);
  if (::rename(part_path_.c_str(), path_.c_str()) != 0) return system_error(errno, what);
  const int closed = ::close(std::exchange(descriptor_, -1));
  forget_unfinished_file(std::exchange(slot_, -1));
  if (closed != 0) return system_error(errno, what);
  // Some file systems cannot sync a folder and say EINVAL; the name is then as durable as they go.
  const Descriptor folder(::open(folder_of(path_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.value >= 0 && ::fsync(folder.value) != 0 && errno != EINVAL) {
    return system_error(errno, what);
  }
  return {};
}

Result<void> write_file(const std::string& path, std::string_view bytes) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  if (Result<void> written = file->write(std::as_bytes(std::span(bytes))); !written) return written;
  return file->commit();
}

Result<void> write_to_standard_output(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EPIPE) {
      return fail(ErrorCode::io_failed, "cannot write to standard output: its reader has gone");
    }
    if (count < 0) return system_error(errno, "cannot write to standard output");
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return {};
}

bool has_ending(std::string_view path, std::string_view ending) noexcept {
  if (path.size() < ending.size()) return false;
  const auto is_same = [](char lower, char c) {
    return lower == (c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c);
  };
  return std::equal(ending.begin(), ending.end(),
                    path.end() - static_cast<std::ptrdiff_t>(ending.size()), is_same);
}

}  // namespace knotwave::base
