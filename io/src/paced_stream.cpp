// SPDX-License-Identifier: MIT
// Sound without a device: blocks at the pace of the clock.
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>

#include "audio_backend.h"
#include "block_pump.h"

namespace knotwave::io {
namespace {

constexpr double kDefaultRateHz = 48000;
constexpr int kDefaultBlock = 256;
// Nobody listens, so a late block is made up for; but a computer that slept does not play its
// sleep.
constexpr std::int64_t kMostLateNs = 1'000'000'000;

class PacedStream final : public AudioStream {
 public:
  PacedStream(const AudioFormat& format, AudioClient& client)
      : format_(format),
        pump_(client, format.rate_hz, format.channels),
        samples_(static_cast<std::size_t>(format.channels * format.block_frames)) {
    for (int c = 0; c < format.channels; ++c) {
      outputs_.push_back(samples_.data() + static_cast<std::ptrdiff_t>(c) * format.block_frames);
    }
  }
  ~PacedStream() override { stop_thread(); }
  PacedStream(const PacedStream&) = delete;
  PacedStream& operator=(const PacedStream&) = delete;

  Result<void> start() override;
  void stop() override { stop_thread(); }
  const AudioFormat& format() const override { return format_; }
  AudioStatus status() override;

 private:
  void stop_thread() noexcept;
  void run();
  std::int64_t due_ns(std::int64_t frame) const;

  AudioFormat format_;
  BlockPump pump_;
  std::vector<float> samples_;
  std::vector<float*> outputs_;
  std::int64_t frame_ = 0, begin_frame_ = 0, begin_ns_ = 0;
  std::atomic<std::int64_t> skips_{0};
  std::mutex mutex_;
  std::condition_variable changed_;
  bool must_end_ = false;
  std::thread thread_;
};

// A double holds nanoseconds exactly for 104 days.
std::int64_t PacedStream::due_ns(std::int64_t frame) const {
  const auto since_s = static_cast<double>(frame - begin_frame_) / format_.rate_hz;
  return begin_ns_ + static_cast<std::int64_t>(since_s * 1e9);
}

void PacedStream::run() {
  using std::chrono::nanoseconds, std::chrono::steady_clock;
  std::unique_lock lock(mutex_);
  while (true) {
    const steady_clock::time_point due{nanoseconds(due_ns(frame_))};
    if (changed_.wait_until(lock, due, [this] { return must_end_; })) return;
    lock.unlock();
    if (const std::int64_t late_ns = steady_clock_ns() - due_ns(frame_); late_ns > kMostLateNs) {
      frame_ += static_cast<std::int64_t>(static_cast<double>(late_ns) * 1e-9 * format_.rate_hz);
      skips_.fetch_add(1, std::memory_order_relaxed);
    }
    pump_.run({.frame = frame_,
               .time_ns = due_ns(frame_),
               .outputs = outputs_,
               .frames = format_.block_frames});
    frame_ += format_.block_frames;
    lock.lock();
  }
}

Result<void> PacedStream::start() {
  if (thread_.joinable()) return {};
  must_end_ = false;
  begin_frame_ = frame_;
  begin_ns_ = steady_clock_ns();
  pump_.open();
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error& fault) {
    return fail(ErrorCode::io_failed, std::string("no thread for the sound: ") + fault.what());
  }
  return {};
}

void PacedStream::stop_thread() noexcept {
  if (!thread_.joinable()) return;
  pump_.close();
  {
    const std::lock_guard lock(mutex_);
    must_end_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

AudioStatus PacedStream::status() {
  const LoadMeter::Figures load = pump_.load();
  AudioStatus status;
  if (thread_.joinable()) status.state = AudioStatus::State::running;
  status.blocks = pump_.blocks();
  status.xruns = skips_.load(std::memory_order_relaxed);
  status.overruns = load.overruns;
  status.load = load.load;
  status.load_p99 = load.p99;
  status.load_max = load.max;
  return status;
}

}  // namespace

OpenedStream open_paced_stream(const AudioConfig& config, AudioClient& client) {
  AudioFormat format;
  format.api = "none";
  format.device = "none";
  format.rate_hz = config.rate_hz == 0 ? kDefaultRateHz : config.rate_hz;
  format.block_frames = config.block_frames == 0 ? kDefaultBlock : config.block_frames;
  format.channels = static_cast<int>(config.channels.size());
  return std::unique_ptr<AudioStream>(new PacedStream(format, client));
}

}  // namespace knotwave::io
