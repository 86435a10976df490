// SPDX-License-Identifier: MIT
// Tells when one of some files was saved, also by editors that write a new file and rename it.
#pragma once
#include <cstdint>
#include <ctime>
#include <map>
#include <string>
#include <vector>

namespace knotwave::synth {

/// inotify on the folders the files are in, and a look at the files themselves now and then: where
/// inotify does not reach (network file systems, the far end of a link) a change is seen a second
/// later. A file that vanishes is no change; its return is. One that stays away is told by
/// take_presence().
class FileWatch {
 public:
  FileWatch();
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;
  ~FileWatch();

  /// These files and no others from now on.
  void watch(const std::vector<std::string>& paths);
  /// Whether one of them was saved and none was touched for 30 ms since, or touches have gone on
  /// for 0.2 s; then false until the next time. With `any_in_folders`, every file in their folders
  /// counts.
  bool is_changed(std::int64_t now_ns, bool any_in_folders = false);
  struct Presence {
    std::string path;  ///< as watch() was given it
    bool is_there = false;
  };
  /// Which files have gone since it was asked last, and which of them came again: those that were
  /// away for half a second and a look, so nobody's way to save is among them. Call is_changed()
  /// before.
  std::vector<Presence> take_presence();
  /// For poll(); -1 without inotify.
  int descriptor() const { return inotify_; }

 private:
  struct Signature {
    std::int64_t size = -1;  ///< -1: not there
    timespec saved{};
    std::uint64_t node = 0;
    bool operator==(const Signature& other) const;
  };
  static Signature signature_of(const std::string& path);
  bool read_events(bool any_in_folders);
  bool look_at_files(std::int64_t now_ns);
  void note_presence(const std::string& path, bool is_there);

  int inotify_;
  std::map<int, std::string> folders_;  ///< by watch descriptor
  struct File {
    std::string given;  ///< its path in the caller's words
    Signature known;
    std::int64_t gone_ns = -1;  ///< not there since; -1: it is there
    bool is_told_gone = false;
  };
  std::map<std::string, File> files_;
  std::vector<Presence> presence_;
  std::int64_t first_touched_ns_ = 0, touched_ns_ = 0, looked_ns_ = 0;
  bool is_touched_ = false;
};

}  // namespace knotwave::synth
