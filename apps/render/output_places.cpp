// SPDX-License-Identifier: MIT
#include "output_places.h"

#include <filesystem>
#include <vector>

#include "knotwave/base/file.h"

#include "song/event_feed.h"

namespace knotwave::render {

namespace fs = std::filesystem;

std::string stem_path(const RenderOptions& options, int channel) {
  const std::string number = std::to_string(channel + 1);
  const std::string name = (number.size() < 2 ? "channel-0" : "channel-") + number;
  const std::string ending = base::has_ending(options.output, ".flac") ? ".flac" : ".wav";
  return (fs::path(options.stems) / (name + ending)).string();
}

std::string output_overlap(const RenderOptions& options, const RenderInput& input) {
  std::vector<command_line::NamedFile> outputs;
  const auto add = [&outputs](const char* role, const std::string& path) {
    if (!path.empty() && path != "-") outputs.push_back({role, path});
  };
  add("--output", options.output);
  add("--json", options.json);
  if (!options.stems.empty()) {
    const std::uint32_t channels = song::EventFeed(input.song, options.rate_hz).channels();
    for (int channel = 0; channel < kMidiChannels; ++channel) {
      if ((channels >> channel & 1) != 0) add("--stems", stem_path(options, channel));
    }
  }
  std::vector<command_line::NamedFile> inputs = input.files;
  if (!options.journal.empty()) inputs.push_back({"the journal", options.journal});
  return command_line::overlap(inputs, outputs);
}

}  // namespace knotwave::render
