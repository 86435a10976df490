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
  std::vector<float> samples;  ///< interleaved [frames*channels]
  int cycle_frames = 0;        ///< frames of one cycle from a `clm ` chunk; 0 without
};

struct SoundReadLimits {
  std::int64_t max_frames = 64 << 20;
  int max_channels = 32;
  double max_magnitude = 1000;  ///< a sample beyond is an error
};

/// WAV (8 to 32 bit, float, double, RF64, W64), AIFF, FLAC, Ogg: what libsndfile opens. Every
/// sample is checked: NaN and infinity are not_finite with their index. Errors: file_not_found,
/// unsupported_format, malformed (no frames, impossible header), file_too_large, not_finite,
/// value_out_of_range, unsupported (built without libsndfile).
Result<Sound> read_sound(const std::string& path, const SoundReadLimits& limits = {});

/// A sound as single cycles for an oscillator: one channel, `frame` samples each, `rows` of them.
struct Cycles {
  int frame = 0;
  int rows = 0;
  std::vector<float> samples;  ///< [rows*frame]
};
/// A `clm ` table is cut by its chunk; an untagged file is one cycle up to 8192 frames, or rows of
/// 2048 where it divides; else value_out_of_range asks for `frame` (0 = decide as above). More than
/// one channel: the first.
Result<Cycles> read_cycles(const std::string& path, int frame = 0);

enum class SampleFormat { pcm16, pcm24, float32 };

struct SoundWriteConfig {
  std::string path;  ///< ".flac" gives FLAC, "-" raw float32 to standard output, else WAV
  int rate_hz = 48000;
  int channels = 2;
  SampleFormat format = SampleFormat::pcm24;
  std::int64_t expected_frames = 0;  ///< chooses RF64 when WAV would pass 4 GiB
  std::uint64_t dither_seed = 1;     ///< TPDF, 1 LSB peak each way, for pcm16 and pcm24
};

/// Writes to a temporary file and renames it in finish(). Without finish() nothing is left behind
/// and an old file of that name is kept.
class SoundWriter {
 public:
  /// Errors: io_failed, disk_full, unsupported_format (FLAC of float32, rates FLAC cannot hold).
  static Result<SoundWriter> create(const SoundWriteConfig& config);
  SoundWriter(SoundWriter&&) noexcept;
  SoundWriter& operator=(SoundWriter&&) noexcept;
  ~SoundWriter();

  /// Interleaved frames. PCM is clipped, counted. Errors: io_failed, disk_full.
  Result<void> write(std::span<const float> interleaved);
  /// Syncs, closes, renames. Errors as write().
  Result<void> finish();
  /// Samples outside -1..1 (PCM) so far.
  std::int64_t clipped() const noexcept;
  /// SHA-256 of the finished file; empty before, and for a pipe.
  std::string file_sha256() const;

 private:
  struct State;
  explicit SoundWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace knotwave::io
