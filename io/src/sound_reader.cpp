// SPDX-License-Identifier: MIT
// Sound files in, through libsndfile: its header checks, our sample checks.
#include "knotwave/io/sound_file.h"

#ifdef KNOTWAVE_HAVE_SNDFILE
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <fcntl.h>
#include <sndfile.h>
#include <sys/stat.h>

#include "descriptor.h"
#include "riff_scan.h"
#endif

namespace knotwave::io {

#ifndef KNOTWAVE_HAVE_SNDFILE

Result<Sound> read_sound(const std::string& path, const SoundReadLimits&) {
  Error error = fail(ErrorCode::unsupported, "this build reads no sound files (no libsndfile)");
  error.source = path;
  return error;
}

#else

namespace {

constexpr std::size_t kSamplesAtOnce = 1 << 14;

Error read_error(ErrorCode code, const std::string& path, std::string message) {
  Error error = fail(code, std::move(message));
  error.source = path;
  return error;
}

Result<Descriptor> open_file(const std::string& path) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.value() < 0) {
    const bool is_missing = errno == ENOENT || errno == ENOTDIR;
    return read_error(is_missing ? ErrorCode::file_not_found : ErrorCode::io_failed, path,
                      is_missing ? "no such file" : std::generic_category().message(errno));
  }
  struct stat info {};
  if (::fstat(file.value(), &info) != 0 || !S_ISREG(info.st_mode)) {
    return read_error(ErrorCode::io_failed, path, "is a folder, device or pipe, not a file");
  }
  return file;
}

struct CloseSndfile {
  void operator()(SNDFILE* file) const { sf_close(file); }
};
using SndfileHandle = std::unique_ptr<SNDFILE, CloseSndfile>;

Error open_error(const std::string& path) {
  const int code = sf_error(nullptr);
  const bool is_unknown = code == SF_ERR_UNRECOGNISED_FORMAT || code == SF_ERR_UNSUPPORTED_ENCODING;
  std::string message = sf_strerror(nullptr);
  while (!message.empty() && (message.back() == '.' || message.back() == '\n')) message.pop_back();
  return read_error(is_unknown ? ErrorCode::unsupported_format : ErrorCode::malformed, path,
                    "libsndfile: " + message);
}

Result<void> check_header(const SF_INFO& info, const std::string& path,
                          const SoundReadLimits& limits) {
  if (info.channels > limits.max_channels) {
    return read_error(ErrorCode::value_out_of_range, path,
                      std::to_string(info.channels) + " channels; at most " +
                          std::to_string(limits.max_channels) + " are read");
  }
  if (info.channels < 1 || info.samplerate < 1) {
    return read_error(
        ErrorCode::malformed, path,
        std::to_string(info.channels) + " channels at " + std::to_string(info.samplerate) + " Hz");
  }
  return {};
}

Result<void> check_samples(std::span<const float> samples, std::int64_t first_frame, int channels,
                           const std::string& path, double max_magnitude) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double magnitude = std::abs(static_cast<double>(samples[i]));
    if (magnitude <= max_magnitude) continue;
    const auto place = static_cast<std::int64_t>(i);
    const std::string where = "frame " + std::to_string(first_frame + place / channels) +
                              " of channel " + std::to_string(place % channels + 1);
    if (!std::isfinite(magnitude)) {
      return read_error(ErrorCode::not_finite, path,
                        where + (std::isnan(samples[i]) ? " is not a number" : " is infinite"));
    }
    return read_error(ErrorCode::value_out_of_range, path,
                      where + " is " + std::to_string(samples[i]) + "; at most " +
                          std::to_string(max_magnitude) + " is read");
  }
  return {};
}

/// Grows with what comes: the number of frames in a header may be anything.
Result<void> read_samples(SNDFILE* file, Sound& sound, const std::string& path,
                          const SoundReadLimits& limits) {
  std::vector<float> block(kSamplesAtOnce -
                           kSamplesAtOnce % static_cast<std::size_t>(sound.channels));
  const auto block_frames = static_cast<sf_count_t>(block.size()) / sound.channels;
  for (;;) {
    const sf_count_t frames = sf_readf_float(file, block.data(), block_frames);
    if (frames <= 0) break;
    const auto count = static_cast<std::size_t>(frames * sound.channels);
    const std::span<const float> samples(block.data(), count);
    if (auto good =
            check_samples(samples, sound.frames, sound.channels, path, limits.max_magnitude);
        !good) {
      return good;
    }
    sound.frames += frames;
    if (sound.frames > limits.max_frames) {
      return read_error(ErrorCode::file_too_large, path,
                        "more than " + std::to_string(limits.max_frames) + " frames");
    }
    sound.samples.insert(sound.samples.end(), samples.begin(), samples.end());
  }
  if (sound.frames == 0) return read_error(ErrorCode::malformed, path, "the file has no frames");
  return {};
}

/// `<!>2048 ...` is a table of cycles of 2048 frames.
std::optional<int> cycle_frames(const std::string& clm) {
  constexpr std::string_view kMark = "<!>";
  if (!clm.starts_with(kMark)) return std::nullopt;
  int frames = 0;
  const char* begin = clm.data() + kMark.size();
  const auto [end, code] = std::from_chars(begin, clm.data() + clm.size(), frames);
  if (code != std::errc{} || frames < kMinCycleFrames || frames > kMaxCycleFrames) {
    return std::nullopt;
  }
  return frames;
}

}  // namespace

Result<Sound> read_sound(const std::string& path, const SoundReadLimits& limits) {
  const auto file = open_file(path);
  if (!file) return file.error();
  SF_INFO info{};
  const SndfileHandle handle(sf_open_fd(file->value(), SFM_READ, &info, SF_FALSE));
  if (!handle) return open_error(path);
  if (const auto good = check_header(info, path, limits); !good) return good.error();
  Sound sound;
  sound.rate_hz = info.samplerate;
  sound.channels = info.channels;
  RiffFacts facts = scan_riff(file->value());
  sound.warnings = std::move(facts.warnings);
  if (const auto good = read_samples(handle.get(), sound, path, limits); !good) return good.error();
  if (!facts.clm.empty()) {
    if (const auto frames = cycle_frames(facts.clm)) {
      sound.cycle_frames = *frames;
    } else {
      sound.warnings.push_back("the 'clm ' chunk gives no frame count from " +
                               std::to_string(kMinCycleFrames) + " to " +
                               std::to_string(kMaxCycleFrames) + " and is not used");
    }
  }
  return sound;
}

#endif

}  // namespace knotwave::io
