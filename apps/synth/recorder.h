// SPDX-License-Identifier: MIT
// A take: what is heard goes through a ring to a thread that writes it, and what was played to a
// journal that renders it again.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "knotwave/base/sha256.h"
#include "knotwave/engine/live_engine.h"
#include "knotwave/io/sound_file.h"

namespace knotwave::synth {

class Recorder {
 public:
  /// Writes what `live` plays from the next block on into `path` (.wav: 32-bit float; .flac: 24
  /// bits), `most_s` seconds at most; 0: as long as the file can be. `live` must outlive it, and
  /// nobody else may take its tap. Errors: those of SoundWriter::create(), io_failed (no thread).
  static Result<std::unique_ptr<Recorder>> start(engine::LiveEngine& live, const std::string& path,
                                                 double rate_hz, double most_s);
  ~Recorder();  ///< drops the take, unless finish() was called

  struct Take {
    std::string path;
    std::int64_t first = 0, frames = 0;  ///< in engine time
    std::string sha256;  ///< of the interleaved float32 samples; empty: some are missing
    std::string fault;   ///< why it ended before it was to; empty: it did not
  };
  /// Writes what is left and completes the file. Errors: those of SoundWriter.
  Result<Take> finish();

  /// The writer failed (a full disk), or the file is as long as it may be: call finish(). [any]
  bool is_over() const { return is_over_; }
  bool has_length() const { return has_length_; }  ///< it ends by itself after `most_s`
  double seconds() const { return static_cast<double>(frames_.load()) / rate_hz_; }
  const std::string& path() const { return path_; }

 private:
  Recorder(engine::LiveEngine& live, std::string path, double rate_hz, double most_s,
           io::SoundWriter writer);
  void run();
  bool write_some();
  bool write(std::span<const float> interleaved);
  bool fill_gap(std::int64_t until);
  bool has_room(std::int64_t frames);

  engine::LiveEngine& live_;
  std::string path_;
  double rate_hz_;
  std::int64_t most_frames_;
  bool has_length_;
  io::SoundWriter writer_;
  base::Sha256 hash_;
  std::vector<float> buffer_;
  std::atomic<std::int64_t> frames_{0};
  std::int64_t first_ = -1;
  std::int64_t reserved_frames_ = 0;
  std::string fault_;
  bool is_whole_ = true;
  Result<void> good_;
  std::atomic<bool> is_over_{false}, is_ending_{false};
  std::thread thread_;
};

/// The first of FILE.wav, FILE-2.wav, FILE-3.wav ... that is not there yet, beginning with the
/// `number`th.
std::string free_take_path(const std::string& path, int number);

}  // namespace knotwave::synth
