// SPDX-License-Identifier: MIT
#include "song_file.h"

#include <utility>

namespace knotwave::song {

Result<SongFile> read(const std::string& path, const std::string& name) {
  auto song = io::read_midi_file(path);
  if (!song) {
    Error error = std::move(song).error();
    if (path != name) error.source = name;
    return error;
  }
  SongFile file{std::move(song).value(), {}};
  for (const auto& warning : file.song.warnings) {
    file.warnings.push_back(name + ": byte " + std::to_string(warning.offset) +
                            ": warning: " + warning.message);
  }
  if (file.song.warnings_left_out > 0) {
    file.warnings.push_back(name + ": warning: " + std::to_string(file.song.warnings_left_out) +
                            " more warnings are left out");
  }
  return file;
}

}  // namespace knotwave::song
