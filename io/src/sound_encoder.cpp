// SPDX-License-Identifier: MIT
// libsndfile writes through calls of ours, because its own do not tell why a write failed, and its
// sf_close() reports success on a full disk.
#include "sound_encoder.h"

#include <algorithm>

#ifdef KNOTWAVE_HAVE_SNDFILE
#include <sndfile.h>
#include <sys/stat.h>

#include "knotwave/base/file.h"

#include "descriptor.h"
#endif

namespace knotwave::io {

#ifndef KNOTWAVE_HAVE_SNDFILE

Result<std::unique_ptr<SoundEncoder>> SoundEncoder::create(const SoundWriteConfig& config, int) {
  return fail(ErrorCode::unsupported, "cannot write '" + config.path +
                                          "': this build writes no sound files (no libsndfile)");
}

#else

namespace {

constexpr std::int64_t kMaxWavBytes = 0xFFFFFFFF;
constexpr std::int64_t kHeaderBytes = 1024;  // more than any header of ours

std::int64_t sample_bytes(SampleFormat format) {
  return format == SampleFormat::pcm16 ? 2 : format == SampleFormat::pcm24 ? 3 : 4;
}

bool passes_wav(const SoundWriteConfig& config, std::int64_t frames) {
  const std::int64_t frame_bytes = config.channels * sample_bytes(config.format);
  return frames > (kMaxWavBytes - kHeaderBytes) / frame_bytes;
}

Error format_error(const SoundWriteConfig& config, const std::string& said) {
  return fail(ErrorCode::unsupported_format, "cannot write '" + config.path + "' with " +
                                                 std::to_string(config.channels) + " channels at " +
                                                 std::to_string(config.rate_hz) + " Hz: " + said);
}

/// libsndfile's format word, or unsupported_format.
Result<int> format_of(const SoundWriteConfig& config) {
  const int samples = config.format == SampleFormat::pcm16   ? SF_FORMAT_PCM_16
                      : config.format == SampleFormat::pcm24 ? SF_FORMAT_PCM_24
                                                             : SF_FORMAT_FLOAT;
  int container = 0;
  if (base::has_ending(config.path, ".flac")) {
    container = SF_FORMAT_FLAC;
    if (config.format == SampleFormat::float32) {
      return fail(ErrorCode::unsupported_format,
                  "cannot write '" + config.path +
                      "': FLAC holds 16 or 24 bits, not 32-bit float; use .wav");
    }
    if (!flac_holds_rate(config.rate_hz)) return format_error(config, kFlacRates);
  } else if (base::has_ending(config.path, ".wav")) {
    container = passes_wav(config, config.expected_frames) ? SF_FORMAT_RF64 : SF_FORMAT_WAV;
  } else {
    return fail(ErrorCode::unsupported_format,
                "cannot write '" + config.path + "': its name ends neither in .wav nor in .flac");
  }
  SF_INFO info{};
  info.samplerate = config.rate_hz;
  info.channels = config.channels;
  info.format = container | samples;
  if (sf_format_check(&info) == 0) return format_error(config, "not known to libsndfile");
  return info.format;
}

class SndfileEncoder : public SoundEncoder {
 public:
  SndfileEncoder(const SoundWriteConfig& config, int format, int descriptor)
      : config_(config), format_(format), descriptor_(descriptor) {}
  ~SndfileEncoder() override {
    if (file_ != nullptr) sf_close(file_);
  }

  Result<void> open() {
    SF_VIRTUAL_IO calls{};
    calls.get_filelen = [](void* self) { return of(self).file_bytes(); };
    calls.seek = [](sf_count_t to, int from, void* self) { return of(self).seek(to, from); };
    calls.read = [](void* out, sf_count_t n, void* self) { return of(self).read(out, n); };
    calls.write = [](const void* in, sf_count_t n, void* self) { return of(self).put(in, n); };
    calls.tell = [](void* self) { return of(self).position_; };
    SF_INFO info{};
    info.samplerate = config_.rate_hz;
    info.channels = config_.channels;
    info.format = format_;
    file_ = sf_open_virtual(&calls, SFM_WRITE, &info, this);
    if (file_ == nullptr && write_error_ == 0) return format_error(config_, sf_strerror(nullptr));
    if (write_error_ != 0) return error({});
    // The PEAK chunk of a float WAV holds the time of writing.
    sf_command(file_, SFC_SET_ADD_PEAK_CHUNK, nullptr, SF_FALSE);
    return {};
  }

  Result<void> write(std::span<const float> samples) override {
    return write_frames(sf_writef_float, samples);
  }
  Result<void> write(std::span<const std::int32_t> samples) override {
    return write_frames(sf_writef_int, samples);
  }

  Result<void> close() override {
    // The header is written with the first frame; without any, the file would be empty.
    if (frames_ == 0) sf_command(file_, SFC_UPDATE_HEADER_NOW, nullptr, 0);
    const int code = sf_close(std::exchange(file_, nullptr));
    if (write_error_ != 0 || code != 0) return error(sf_error_number(code));
    return {};
  }

 private:
  static SndfileEncoder& of(void* self) { return *static_cast<SndfileEncoder*>(self); }

  template <class Call, class Sample>
  Result<void> write_frames(Call call, std::span<const Sample> samples) {
    const auto frames = static_cast<sf_count_t>(samples.size()) / config_.channels;
    frames_ += frames;
    if (format_is(SF_FORMAT_WAV) && passes_wav(config_, frames_)) {
      return fail(ErrorCode::file_too_large,
                  "cannot write '" + config_.path +
                      "': more than the 4 GiB of a WAV file, which was not announced");
    }
    const sf_count_t done = call(file_, samples.data(), frames);
    if (done != frames || write_error_ != 0) return error(sf_strerror(file_));
    return {};
  }

  bool format_is(int container) const { return (format_ & SF_FORMAT_TYPEMASK) == container; }

  Error error(const std::string& said) const {
    const std::string what = "cannot write '" + config_.path + "'";
    if (write_error_ != 0) return system_error(write_error_, what);
    return fail(ErrorCode::io_failed, what + ": libsndfile: " + said);
  }

  sf_count_t file_bytes() const {
    struct stat info {};
    return ::fstat(descriptor_, &info) == 0 ? info.st_size : -1;
  }
  sf_count_t seek(sf_count_t to, int from) {
    position_ = from == SEEK_SET ? to : from == SEEK_CUR ? position_ + to : file_bytes() + to;
    return position_;
  }
  sf_count_t read(void* out, sf_count_t count) {
    const ssize_t done = ::pread(descriptor_, out, static_cast<std::size_t>(count), position_);
    if (done > 0) position_ += done;
    return std::max<ssize_t>(done, 0);
  }
  sf_count_t put(const void* in, sf_count_t count) {
    const auto* bytes = static_cast<const char*>(in);
    sf_count_t done = 0;
    while (done < count && write_error_ == 0) {
      const ssize_t n = ::pwrite(descriptor_, bytes + done, static_cast<std::size_t>(count - done),
                                 position_ + done);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) write_error_ = n < 0 ? errno : ENOSPC;
      if (n > 0) done += n;
    }
    position_ += done;
    return done;
  }

  SoundWriteConfig config_;
  int format_;
  int descriptor_;
  SNDFILE* file_ = nullptr;
  sf_count_t position_ = 0;
  sf_count_t frames_ = 0;
  int write_error_ = 0;  ///< errno of the first write that failed
};

}  // namespace

Result<std::unique_ptr<SoundEncoder>> SoundEncoder::create(const SoundWriteConfig& config,
                                                           int descriptor) {
  const auto format = format_of(config);
  if (!format) return format.error();
  auto encoder = std::make_unique<SndfileEncoder>(config, *format, descriptor);
  if (const auto opened = encoder->open(); !opened) return opened.error();
  return std::unique_ptr<SoundEncoder>(std::move(encoder));
}

#endif

}  // namespace knotwave::io
