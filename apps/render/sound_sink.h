// SPDX-License-Identifier: MIT
// Where rendered samples go: measured, hashed, written.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "knotwave/base/sha256.h"
#include "knotwave/io/sound_file.h"

namespace knotwave::render {

/// Of samples in -1..1; silence is -infinity dBFS.
struct Levels {
  double peak = 0;
  double sum_of_squares = 0;
  std::int64_t samples = 0;
  double peak_dbfs() const;
  double rms_dbfs() const;  ///< a full-scale square wave is 0
};

/// One stereo output. Hash and levels are of the samples as floats, before any conversion.
class SoundSink {
 public:
  static Result<SoundSink> create(const io::SoundWriteConfig& config);

  Result<void> add(std::span<const float> left, std::span<const float> right);
  /// Writes what is left and completes the file.
  Result<void> finish();

  const std::string& path() const { return path_; }
  const Levels& levels() const { return levels_; }
  std::int64_t frames() const { return levels_.samples / 2; }
  const std::string& sha256() const { return sha256_; }  ///< of the floats; after finish()
  const io::SoundWriter& writer() const { return writer_; }

 private:
  SoundSink(std::string path, io::SoundWriter writer);
  Result<void> flush();

  std::string path_;
  io::SoundWriter writer_;
  std::vector<float> pending_;  ///< interleaved: small blocks are written together
  Levels levels_;
  base::Sha256 hash_;
  std::string sha256_;
};

}  // namespace knotwave::render
