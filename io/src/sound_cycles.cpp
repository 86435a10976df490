// SPDX-License-Identifier: MIT
// Sampled cycles for oscillators.
#include "knotwave/io/sound_file.h"

namespace knotwave::io {
namespace {

constexpr std::int64_t kLongestUntaggedCycle = 8192;
constexpr int kUsualTableFrame = 2048;

Error cycle_error(const std::string& path, std::string message) {
  Error error = fail(ErrorCode::value_out_of_range, std::move(message));
  error.source = path;
  return error;
}

/// Frames of one cycle; 0 where the file does not say and no rule decides.
std::int64_t decide_frame(const Sound& sound, int asked) {
  if (asked > 0) return asked;
  if (sound.cycle_frames > 0) return sound.cycle_frames;
  if (sound.frames <= kLongestUntaggedCycle) return sound.frames;
  return sound.frames % kUsualTableFrame == 0 ? kUsualTableFrame : 0;
}

}  // namespace

Result<Cycles> read_cycles(const std::string& path, int frame) {
  auto sound = read_sound(path);
  if (!sound) return std::move(sound).error();
  const std::int64_t length = decide_frame(*sound, frame);
  if (length == 0) {
    return cycle_error(path, "how long is a cycle in these " + std::to_string(sound->frames) +
                                 " frames? It has no 'clm ' chunk and is no multiple of " +
                                 std::to_string(kUsualTableFrame) + ": give the frame");
  }
  if (length < kMinCycleFrames || length > kMaxCycleFrames || length > sound->frames) {
    return cycle_error(path, "a cycle of " + std::to_string(length) + " frames in a file of " +
                                 std::to_string(sound->frames) + "; " +
                                 std::to_string(kMinCycleFrames) + " to " +
                                 std::to_string(kMaxCycleFrames) + " are possible");
  }
  Cycles cycles;
  cycles.frame = static_cast<int>(length);
  cycles.rows = static_cast<int>(sound->frames / length);
  cycles.warnings = std::move(sound->warnings);
  const std::int64_t kept = cycles.rows * length;
  if (kept < sound->frames) {
    cycles.warnings.push_back("the last " + std::to_string(sound->frames - kept) +
                              " frames are no whole cycle and are left out");
  }
  if (sound->channels > 1) {
    cycles.warnings.push_back("only the first of " + std::to_string(sound->channels) +
                              " channels is used");
  }
  cycles.samples.reserve(static_cast<std::size_t>(kept));
  for (std::int64_t i = 0; i < kept; ++i) {
    cycles.samples.push_back(sound->samples[static_cast<std::size_t>(i * sound->channels)]);
  }
  return cycles;
}

}  // namespace knotwave::io
