// SPDX-License-Identifier: MIT
#include "recorder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "knotwave/base/file.h"

namespace knotwave::synth {
namespace {

constexpr std::size_t kBufferFrames = 16384;
constexpr std::int64_t kReserveFrames = 32768;
constexpr auto kPause = std::chrono::milliseconds(5);
/// A WAV ends at 4 GiB: 8 bytes a frame, and room for the header.
constexpr std::int64_t kMostFrames = ((std::int64_t{1} << 32) - 65536) / 8;

std::int64_t frames_of(double most_s, double rate_hz) {
  const double frames = std::floor(most_s * rate_hz + 0.5);
  const bool is_limit = frames >= 1 && frames < static_cast<double>(kMostFrames);
  return is_limit ? static_cast<std::int64_t>(frames) : kMostFrames;
}

}  // namespace

Result<std::unique_ptr<Recorder>> Recorder::start(engine::LiveEngine& live, const std::string& path,
                                                  double rate_hz, double most_s) {
  const bool is_flac = base::has_ending(path, ".flac");
  auto writer = io::SoundWriter::create(
      {.path = path,
       .rate_hz = static_cast<int>(std::lround(rate_hz)),
       .channels = 2,
       .format = is_flac ? io::SampleFormat::pcm24 : io::SampleFormat::float32});
  if (!writer) return writer.error();
  try {
    return std::unique_ptr<Recorder>(
        new Recorder(live, path, rate_hz, most_s, std::move(writer).value()));
  } catch (const std::system_error& fault) {
    live.set_tap(false);
    return fail(ErrorCode::io_failed, "no thread for the take: " + fault.code().message());
  }
}

Recorder::Recorder(engine::LiveEngine& live, std::string path, double rate_hz, double most_s,
                   io::SoundWriter writer)
    : live_(live),
      path_(std::move(path)),
      rate_hz_(rate_hz),
      most_frames_(frames_of(most_s, rate_hz)),
      has_length_(most_s > 0),
      writer_(std::move(writer)),
      buffer_(2 * kBufferFrames) {
  while (live_.take_tap(buffer_).frames > 0) {  // what a take before left there
  }
  live_.set_tap(true);
  thread_ = std::thread([this] { run(); });
}

Recorder::~Recorder() {
  if (!thread_.joinable()) return;
  live_.set_tap(false);
  is_ending_ = true;
  thread_.join();
}

void Recorder::run() {
  while (!is_ending_) {
    if (!write_some()) std::this_thread::sleep_for(kPause);
  }
  while (write_some()) {
  }
}

/// False: there is nothing to write just now.
bool Recorder::write_some() {
  const auto tap = live_.take_tap(buffer_);
  if (tap.frames == 0) return false;
  if (first_ < 0) first_ = tap.first;
  if (is_over_) return true;  // read and dropped, so that the ring stays free
  if (fill_gap(tap.first)) write(std::span(buffer_).first(2 * tap.frames));
  return true;
}

/// Samples that the ring had no room for become silence, so that what follows stays in time.
bool Recorder::fill_gap(std::int64_t until) {
  constexpr std::int64_t kSilenceFrames = 4096;
  static constexpr float kSilence[2 * kSilenceFrames] = {};
  for (std::int64_t left = until - first_ - frames_; left > 0 && !is_over_;) {
    is_whole_ = false;
    const std::int64_t now = std::min(left, kSilenceFrames);
    write(std::span(kSilence).first(static_cast<std::size_t>(2 * now)));
    left -= now;
  }
  return !is_over_;
}

bool Recorder::write(std::span<const float> interleaved) {
  const std::int64_t frames =
      std::min(static_cast<std::int64_t>(interleaved.size() / 2), most_frames_ - frames_);
  interleaved = interleaved.first(static_cast<std::size_t>(2 * frames));
  if (!has_room(frames)) {
    is_over_ = true;
    return false;
  }
  good_ = writer_.write(interleaved);
  if (!good_) {
    is_over_ = true;
    return false;
  }
  hash_.update(interleaved);
  frames_ += frames;
  is_over_ = frames_ == most_frames_;
  return true;
}

/// Room for what comes is reserved before it is needed, and as much again for the files beside it:
/// so a disk that is full ends a take that is good up to there.
bool Recorder::has_room(std::int64_t frames) {
  if (frames_ + frames <= reserved_frames_) return true;
  constexpr std::int64_t kFrameBytes = 8;
  const std::int64_t ahead = frames + kReserveFrames;
  const auto reserved = writer_.reserve(ahead * kFrameBytes);
  reserved_frames_ = frames_ + frames + kReserveFrames / 2;
  if (!reserved) fault_ = reserved.error().message;
  return reserved.has_value();
}

Result<Recorder::Take> Recorder::finish() {
  live_.set_tap(false);
  // A block that is being rendered just now is still kept.
  std::this_thread::sleep_for(kPause);
  is_ending_ = true;
  thread_.join();
  if (!good_) return good_.error();
  if (auto good = writer_.finish(); !good) return good.error();
  Take take{path_, std::max<std::int64_t>(first_, 0), frames_, {}, fault_};
  if (is_whole_) take.sha256 = hash_.finish_hex();
  return take;
}

std::string free_take_path(const std::string& path, int number) {
  namespace fs = std::filesystem;
  const fs::path whole(path);
  for (int i = number;; ++i) {
    const std::string name =
        i == 1 ? whole.filename().string()
               : whole.stem().string() + "-" + std::to_string(i) + whole.extension().string();
    const fs::path next = whole.has_parent_path() ? whole.parent_path() / name : fs::path(name);
    std::error_code failed;
    if (!fs::exists(next, failed)) return next.string();
  }
}

}  // namespace knotwave::synth
