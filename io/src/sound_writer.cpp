// SPDX-License-Identifier: MIT
// What every output shares: the temporary file, the check of each sample, dither, and the pipe.
#include <cmath>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>

#include "knotwave/base/file.h"
#include "knotwave/base/sha256.h"
#include "knotwave/io/sound_file.h"

#include "descriptor.h"
#include "quantiser.h"
#include "sound_encoder.h"

namespace knotwave::io {
namespace {

Result<std::string> sha256_of(int descriptor, const std::string& path) {
  base::Sha256 hash;
  std::vector<std::byte> block(1 << 16);
  for (std::int64_t at = 0;;) {
    const ssize_t count = ::pread(descriptor, block.data(), block.size(), at);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_error(errno, "cannot read back '" + path + "'");
    if (count == 0) return hash.finish_hex();
    hash.update(std::span<const std::byte>(block.data(), static_cast<std::size_t>(count)));
    at += count;
  }
}

Result<void> check_config(const SoundWriteConfig& config) {
  if (config.channels >= 1 && config.rate_hz >= 1 && config.expected_frames >= 0) return {};
  return fail(ErrorCode::value_out_of_range, "cannot write " + std::to_string(config.channels) +
                                                 " channels at " + std::to_string(config.rate_hz) +
                                                 " Hz");
}

}  // namespace

struct SoundWriter::State {
  SoundWriteConfig config;
  std::optional<base::AtomicFile> file;  ///< none: standard output
  std::unique_ptr<SoundEncoder> encoder;
  std::optional<Quantiser> quantiser;  ///< none: float32
  std::vector<std::int32_t> integers;
  std::int64_t frames = 0;
  std::string sha256;

  Result<void> check(std::span<const float> samples) const {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (std::isfinite(samples[i])) continue;
      const auto place = static_cast<std::int64_t>(i);
      return fail(ErrorCode::not_finite,
                  "frame " + std::to_string(frames + place / config.channels) + " of channel " +
                      std::to_string(place % config.channels + 1) + " is not a finite number");
    }
    return {};
  }
};

SoundWriter::SoundWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
SoundWriter::SoundWriter(SoundWriter&&) noexcept = default;
SoundWriter& SoundWriter::operator=(SoundWriter&&) noexcept = default;
SoundWriter::~SoundWriter() = default;

Result<SoundWriter> SoundWriter::create(const SoundWriteConfig& config) {
  if (const auto good = check_config(config); !good) return good.error();
  auto state = std::make_unique<State>();
  state->config = config;
  if (config.path == "-") return SoundWriter(std::move(state));
  auto file = base::AtomicFile::create(config.path);
  if (!file) return std::move(file).error();
  state->file = std::move(file).value();
  auto encoder = SoundEncoder::create(config, state->file->descriptor());
  if (!encoder) return std::move(encoder).error();
  state->encoder = std::move(encoder).value();
  if (config.format != SampleFormat::float32) {
    const int bits = config.format == SampleFormat::pcm16 ? 16 : 24;
    state->quantiser.emplace(bits, config.channels, config.dither_seed);
  }
  return SoundWriter(std::move(state));
}

Result<void> SoundWriter::write(std::span<const float> interleaved) {
  State& s = *state_;
  KNOTWAVE_ASSERT(interleaved.size() % static_cast<std::size_t>(s.config.channels) == 0);
  if (auto good = s.check(interleaved); !good) return good;
  s.frames += static_cast<std::int64_t>(interleaved.size()) / s.config.channels;
  // Raw float32: the machines we build for are little-endian.
  if (!s.file) return base::write_to_standard_output(std::as_bytes(interleaved));
  if (!s.quantiser) return s.encoder->write(interleaved);
  s.integers.resize(interleaved.size());
  s.quantiser->quantise(interleaved, s.integers);
  return s.encoder->write(std::span<const std::int32_t>(s.integers));
}

Result<void> SoundWriter::reserve(std::int64_t bytes) {
#ifdef FALLOC_FL_KEEP_SIZE
  const State& s = *state_;
  struct stat info {};
  if (!s.file || ::fstat(s.file->descriptor(), &info) != 0) return {};
  const int done = ::fallocate(s.file->descriptor(), FALLOC_FL_KEEP_SIZE, info.st_size, bytes);
  if (done != 0 && (errno == ENOSPC || errno == EDQUOT)) {
    return system_error(errno, "cannot write '" + s.config.path + "'");
  }
#endif
  return {};
}

Result<void> SoundWriter::finish() {
  State& s = *state_;
  if (!s.file) return {};
  if (auto closed = s.encoder->close(); !closed) return closed;
  // What was reserved and not needed is given back.
  struct stat info {};
  if (::fstat(s.file->descriptor(), &info) == 0 &&
      ::ftruncate(s.file->descriptor(), info.st_size) != 0) {
    return system_error(errno, "cannot write '" + s.config.path + "'");
  }
  auto sha256 = sha256_of(s.file->descriptor(), s.config.path);
  if (!sha256) return std::move(sha256).error();
  if (auto committed = s.file->commit(); !committed) return committed;
  s.sha256 = std::move(sha256).value();
  return {};
}

std::int64_t SoundWriter::clipped() const noexcept {
  return state_->quantiser ? state_->quantiser->clipped() : 0;
}

const std::string& SoundWriter::file_sha256() const noexcept { return state_->sha256; }

}  // namespace knotwave::io
