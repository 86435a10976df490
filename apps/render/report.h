// SPDX-License-Identifier: MIT
// What a render says at its end, as one line and as JSON.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace knotwave::render {

/// A number with so many decimals, in any locale; infinities read `inf` and `-inf`.
std::string fixed(double value, int decimals);

struct StemReport {
  std::string path;
  int channel = 0;  ///< 1..16
  std::string sha256, sha256_file;
  double peak_dbfs = 0;
};

struct RenderReport {
  std::string path;
  std::int64_t frames = 0;
  int rate_hz = 0;
  int channels = 2;
  double peak_dbfs = 0, rms_dbfs = 0;  ///< -infinity for silence
  std::uint64_t seed = 0;
  std::string sha256;       ///< of the interleaved float32 samples, before conversion
  std::string sha256_file;  ///< empty for a pipe
  double realtime_factor = 0;
  int voices_peak = 0;
  std::int64_t voices_stolen = 0;
  std::int64_t notes_without_patch = 0;
  std::int64_t clipped_samples = 0;
  std::vector<StemReport> stems;
  std::vector<std::string> warnings;

  double seconds() const { return static_cast<double>(frames) / rate_hz; }
};

/// `out.wav: 8.000 s, 48000 Hz, 2 channels, peak -6.02 dBFS, ... sha256 <hex>, 41.2 times real
/// time`
std::string report_line(const RenderReport& report);
/// One object, keys in fixed order; a level of silence is null.
std::string report_json(const RenderReport& report);

}  // namespace knotwave::render
