// SPDX-License-Identifier: MIT
// A MIDI file as a program reads it: the song, and what is worth telling about it.
#pragma once
#include <string>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/io/midi_file.h"

namespace knotwave::song {

struct SongFile {
  io::Song song;
  std::vector<std::string> warnings;  ///< "song.mid: byte 20: warning: ..."
};

/// `name` is what the song is called in messages. Errors: those of io::read_midi_file().
Result<SongFile> read(const std::string& path, const std::string& name);

}  // namespace knotwave::song
