// SPDX-License-Identifier: MIT
#include "command_line/places.h"

#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <sys/stat.h>

namespace knotwave::command_line {
namespace {

/// Where a name leads.
struct Place {
  const NamedFile* file = nullptr;
  std::optional<std::pair<dev_t, ino_t>> node;  ///< none while no file is there
  std::string path;                             ///< links followed as far as there are files
};

Place place_of(const NamedFile& file) {
  const std::string name = file.path == "-" ? "/dev/stdin" : file.path;
  Place place{&file, {}, name};
  struct stat info {};
  if (::stat(name.c_str(), &info) == 0) place.node = {info.st_dev, info.st_ino};
  std::error_code failed;
  const auto absolute = std::filesystem::absolute(name, failed);  // "new/a" names no file yet
  if (!failed) place.path = std::filesystem::weakly_canonical(absolute, failed).string();
  if (failed) place.path = name;
  return place;
}

bool are_one_file(const Place& a, const Place& b) {
  return a.path == b.path || (a.node && a.node == b.node);
}

std::string named(const NamedFile& file) { return file.role + " '" + file.path + "'"; }

}  // namespace

std::string overlap(std::span<const NamedFile> inputs, std::span<const NamedFile> outputs) {
  std::vector<Place> read, written;
  for (const NamedFile& input : inputs) read.push_back(place_of(input));
  for (const NamedFile& output : outputs) {
    const Place place = place_of(output);
    for (const Place& other : read) {
      if (are_one_file(place, other))
        return named(output) + " would overwrite " + named(*other.file);
    }
    for (const Place& other : written) {
      if (are_one_file(place, other)) {
        return named(*other.file) + " and " + named(output) + " are the same file";
      }
    }
    written.push_back(place);
  }
  return {};
}

}  // namespace knotwave::command_line
