// SPDX-License-Identifier: MIT
#include "take_files.h"

#include <filesystem>
#include <string_view>
#include <system_error>

#include "knotwave/base/file.h"

#include "take/take.h"
#include "take/take_midi.h"

namespace knotwave::synth {
namespace {

std::string beside(const std::string& sound, const char* ending) {
  return std::filesystem::path(sound).replace_extension(ending).string();
}

Result<void> write_midi(const std::string& path, const engine::Journal& journal) {
  const auto song = take::midi_song(journal);
  if (!song) return song.error();
  const auto bytes = io::write_midi(*song);
  return base::write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace

std::vector<std::string> take_files_there(const std::string& path) {
  std::vector<std::string> there;
  for (const std::string& file : {path, beside(path, ".journal"), beside(path, ".mid")}) {
    std::error_code failed;
    if (std::filesystem::exists(file, failed)) there.push_back(file);
  }
  return there;
}

std::vector<std::string> write_take_files(const Recorder::Take& take, engine::Journal journal) {
  journal.first = take.first;
  journal.end = take.first + take.frames;
  journal.sha256 = take.sha256;
  std::vector<std::string> faults;
  if (auto good = take::write_take(beside(take.path, ".journal"), journal); !good) {
    faults.push_back("no journal of the take: " + good.error().to_string());
  }
  if (auto good = write_midi(beside(take.path, ".mid"), journal); !good) {
    faults.push_back("no MIDI file of the take: " + good.error().to_string());
  }
  return faults;
}

}  // namespace knotwave::synth
