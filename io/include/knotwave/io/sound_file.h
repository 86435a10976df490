// SPDX-License-Identifier: MIT
// Sound files through libsndfile, with what it does not check checked here. [control]
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "knotwave/base/result.h"

namespace knotwave::io {

/// What a file held, as floats.
struct Sound {
  int rate_hz = 0;
  int channels = 0;
  std::int64_t frames = 0;
  std::vector<float> samples;         ///< interleaved [frames*channels]
  int cycle_frames = 0;               ///< frames of one cycle from a `clm ` chunk; 0 without
  std::vector<std::string> warnings;  ///< a file cut short, a `clm ` chunk that makes no sense
};

struct SoundReadLimits {
  std::int64_t max_frames = 64 << 20;
  int max_channels = 32;
  double max_magnitude = 1000;  ///< a sample beyond is an error
};

/// WAV (8 to 32 bit, float, double, RF64, W64), AIFF, FLAC, Ogg: what libsndfile opens. Every
/// sample is checked: NaN and infinity are not_finite with their frame and channel. Memory follows
/// what the file holds, never what its header says. Errors: file_not_found, io_failed,
/// unsupported_format, malformed (no frames, impossible header), file_too_large, not_finite,
/// value_out_of_range (too many channels, too loud), unsupported (built without libsndfile).
Result<Sound> read_sound(const std::string& path, const SoundReadLimits& limits = {});

/// A sound as single cycles for an oscillator: one channel, `frame` samples each, `rows` of them.
struct Cycles {
  int frame = 0;
  int rows = 0;
  std::vector<float> samples;  ///< [rows*frame]
  std::vector<std::string> warnings;
};
inline constexpr int kMinCycleFrames = 4;
inline constexpr int kMaxCycleFrames = 65536;

/// `frame` samples a cycle (kMinCycleFrames..kMaxCycleFrames), or 0 to decide: a `clm ` table is
/// cut by its chunk; an untagged file of up to 8192 frames is one cycle; a longer one is rows of
/// 2048 where that divides it, else value_out_of_range asks for `frame`. More than one channel: the
/// first. Frames after the last whole cycle are left out with a warning. Errors: as read_sound().
Result<Cycles> read_cycles(const std::string& path, int frame = 0);

enum class SampleFormat { pcm16, pcm24, float32 };

/// The rates a frame of FLAC can name (RFC 9639, section 9.1.2), which is what libsndfile writes:
/// up to 65535 Hz, and up to 655350 Hz in steps of 10.
constexpr bool flac_holds_rate(int rate_hz) {
  return rate_hz >= 1 && (rate_hz <= 65535 || (rate_hz <= 655350 && rate_hz % 10 == 0));
}
inline constexpr const char* kFlacRates =
    "FLAC holds rates to 65535 Hz, and multiples of 10 to 655350 Hz";

struct SoundWriteConfig {
  std::string path;  ///< ".wav" or ".flac", in any case; "-" is raw float32 little-endian to
                     ///< standard output
  int rate_hz = 48000;
  int channels = 2;
  SampleFormat format = SampleFormat::pcm24;
  std::int64_t expected_frames = 0;  ///< at most; chooses RF64 where WAV would pass 4 GiB
  std::uint64_t dither_seed = 1;     ///< TPDF, 1 LSB peak each way, for pcm16 and pcm24
};

/// Writes to a temporary file and renames it in finish(). Without finish() nothing is left behind
/// and an old file of that name is kept. The bytes depend on the configuration and the samples
/// only, not on the time, the machine or how the samples were split over write() calls.
class SoundWriter {
 public:
  /// Errors: io_failed, disk_full, unsupported_format (another ending, FLAC of float32 or of a rate
  /// or channel count it cannot hold), unsupported (a file, built without libsndfile).
  static Result<SoundWriter> create(const SoundWriteConfig& config);
  SoundWriter(SoundWriter&&) noexcept;
  SoundWriter& operator=(SoundWriter&&) noexcept;
  ~SoundWriter();

  /// Interleaved frames. PCM is clipped, counted. Errors: io_failed, disk_full, not_finite,
  /// file_too_large (a WAV of more than 4 GiB that expected_frames did not announce).
  Result<void> write(std::span<const float> interleaved);
  /// Sets `bytes` behind those written aside for what comes next, until finish(); where the file
  /// system has no way to, it does nothing. Errors: disk_full, and what was written is still good.
  Result<void> reserve(std::int64_t bytes);
  /// Syncs, closes, renames. Errors as write().
  Result<void> finish();
  /// Samples outside -1..1 (PCM) so far.
  std::int64_t clipped() const noexcept;
  /// SHA-256 of the finished file; empty before, and for a pipe.
  const std::string& file_sha256() const noexcept;

 private:
  struct State;
  explicit SoundWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace knotwave::io
