// SPDX-License-Identifier: MIT
// A stream over PortAudio. Whatever of PortAudio may hang runs inside portaudio_calls().
#include <algorithm>

#include "knotwave/base/document.h"

#include "block_pump.h"
#include "block_watch.h"
#include "portaudio_library.h"

namespace knotwave::io {
namespace {

constexpr std::chrono::milliseconds kOpensWithin{5000}, kStartsWithin{3000};
constexpr std::chrono::milliseconds kStopsWithin{700};
constexpr double kMostLatencySeconds = 10;  // PipeWire has said 89478 s

/// What the callback works on. Destroyed inside portaudio_calls().
class PortAudioDevice {
 public:
  PortAudioDevice(AudioClient& client, double rate_hz, const std::vector<int>& channels)
      : pump_(client, rate_hz, static_cast<int>(channels.size())),
        channels_(channels),
        count_(*std::max_element(channels.begin(), channels.end())),
        mapped_(channels.size()) {}
  ~PortAudioDevice() {
    if (stream_ == nullptr) return;
    if (Pa_IsStreamActive(stream_) == 1) Pa_AbortStream(stream_);
    Pa_CloseStream(stream_);
  }
  PortAudioDevice(const PortAudioDevice&) = delete;
  PortAudioDevice& operator=(const PortAudioDevice&) = delete;

  Result<void> open(const AudioConfig& config, const FoundDevice& device);

  PaStream* stream() const noexcept { return stream_; }
  BlockPump& pump() noexcept { return pump_; }
  std::int64_t xruns() const noexcept { return xruns_.load(std::memory_order_relaxed); }
  /// Of the last block, 0 before the first.
  int block_frames() const noexcept { return block_frames_.load(std::memory_order_relaxed); }

 private:
  void fill(float* const* outputs, int frames, PaStreamCallbackFlags flags) KNOTWAVE_RT;

  std::unique_ptr<PortAudioUse> use_;  ///< outlives the stream
  BlockPump pump_;
  std::vector<int> channels_;
  int count_;  ///< channels of the device that are open
  std::vector<float*> mapped_;
  std::int64_t frame_ = 0, time_ns_ = 0;
  std::atomic<std::int64_t> xruns_{0};
  std::atomic<int> block_frames_{0};
  PaStream* stream_ = nullptr;
};

void PortAudioDevice::fill(float* const* outputs, int frames,
                           PaStreamCallbackFlags flags) KNOTWAVE_RT {
  time_ns_ = std::max(time_ns_, steady_clock_ns());
  block_frames_.store(frames, std::memory_order_relaxed);
  if ((flags & paOutputUnderflow) != 0) xruns_.fetch_add(1, std::memory_order_relaxed);
  if (static_cast<std::size_t>(count_) > mapped_.size()) {  // channels nobody writes
    for (int c = 0; c < count_; ++c) std::fill_n(outputs[c], frames, 0.0F);
  }
  for (std::size_t c = 0; c < mapped_.size(); ++c) mapped_[c] = outputs[channels_[c] - 1];
  pump_.run({.frame = frame_, .time_ns = time_ns_, .outputs = mapped_, .frames = frames});
  frame_ += frames;
}

Error refused(PaError fault, const FoundDevice& device, double rate_hz) {
  const std::string who = device.info.api + " '" + device.info.name + "': ";
  if (fault == paInvalidSampleRate) {
    return fail(ErrorCode::unsupported, who + "a rate of " + base::number_text(rate_hz) +
                                            " Hz is not possible; its own is " +
                                            base::number_text(device.info.rate_hz) + " Hz");
  }
  std::string what = Pa_GetErrorText(fault);
  if (fault == paDeviceUnavailable) what += " (another program may hold it)";
  if (fault == paUnanticipatedHostError) {
    const PaHostErrorInfo* const host = Pa_GetLastHostErrorInfo();
    if (host != nullptr && host->errorText != nullptr) what += std::string(": ") + host->errorText;
  }
  return fail(ErrorCode::io_failed, who + what);
}

Result<void> PortAudioDevice::open(const AudioConfig& config, const FoundDevice& device) {
  use_ = std::make_unique<PortAudioUse>(config.client_name);
  if (!use_->error().empty()) return fail(ErrorCode::io_failed, use_->error());
  const PaDeviceInfo* const info = Pa_GetDeviceInfo(device.library_number);
  if (info == nullptr || device.info.name != info->name) {
    return fail(ErrorCode::io_failed, "the devices have just changed: try again");
  }
  const PaStreamParameters output{
      .device = device.library_number,
      .channelCount = count_,
      .sampleFormat = paFloat32 | paNonInterleaved,
      .suggestedLatency = config.latency_s == 0 ? info->defaultLowOutputLatency : config.latency_s,
      .hostApiSpecificStreamInfo = nullptr};
  const auto block = static_cast<unsigned long>(config.block_frames);
  // Zero frames are PortAudio's own word for "as the device likes".
  static_assert(paFramesPerBufferUnspecified == 0);
  const PaError fault = Pa_OpenStream(
      &stream_, nullptr, &output, config.rate_hz, block, paDitherOff,
      [](const void*, void* outputs, unsigned long frames, const PaStreamCallbackTimeInfo*,
         PaStreamCallbackFlags flags, void* us) -> int {
        static_cast<PortAudioDevice*>(us)->fill(static_cast<float* const*>(outputs),
                                                static_cast<int>(frames), flags);
        return paContinue;
      },
      this);
  if (fault == paNoError) return {};
  stream_ = nullptr;
  return refused(fault, device, config.rate_hz);
}

class PortAudioStream final : public AudioStream {
 public:
  PortAudioStream(std::shared_ptr<PortAudioDevice> device, AudioFormat format)
      : device_(std::make_unique<std::shared_ptr<PortAudioDevice>>(std::move(device))),
        format_(std::move(format)) {}
  // The device goes with the call that closes it, however late, and stays where that is refused.
  ~PortAudioStream() override {
    device().pump().close();
    run_portaudio(kStopsWithin, [device = device_.release()] { delete device; });
  }
  PortAudioStream(const PortAudioStream&) = delete;
  PortAudioStream& operator=(const PortAudioStream&) = delete;

  Result<void> start() override;
  void stop() override;
  const AudioFormat& format() const override { return format_; }
  AudioStatus status() override;

 private:
  void look();

  PortAudioDevice& device() const noexcept { return **device_; }

  std::unique_ptr<std::shared_ptr<PortAudioDevice>>
      device_;  ///< held so that it can be left behind
  AudioFormat format_;
  bool is_started_ = false;
  std::string lost_;  ///< why
  BlockWatch watch_;
};

Result<void> PortAudioStream::start() {
  if (!lost_.empty()) return fail(ErrorCode::io_failed, lost_);
  if (is_started_) return {};
  device().pump().open();
  const auto fault = std::make_shared<PaError>(paTimedOut);
  run_portaudio(kStartsWithin, [device = *device_, fault] {
    *fault = Pa_IsStreamActive(device->stream()) == 1 ? static_cast<PaError>(paNoError)
                                                      : Pa_StartStream(device->stream());
  });
  if (*fault != paNoError) {
    device().pump().close();
    return fail(ErrorCode::io_failed,
                format_.api + " '" + format_.device + "': " + Pa_GetErrorText(*fault));
  }
  watch_.restart(steady_clock_ns());
  is_started_ = true;
  return {};
}

void PortAudioStream::stop() {
  device().pump().close();
  if (!is_started_) return;
  is_started_ = false;
  if (!lost_.empty()) return;  // it would hang
  const auto outcome =
      run_portaudio(kStopsWithin, [device = *device_] { Pa_StopStream(device->stream()); });
  if (outcome != PatientCall::Outcome::done) lost_ = kPortAudioHangs;
}

void PortAudioStream::look() {
  if (!is_started_) return;
  if (device().block_frames() > 0) format_.block_frames = device().block_frames();
  const double length_ns = format_.block_frames / format_.rate_hz * 1e9;
  if (Pa_IsStreamActive(device().stream()) != 1) {
    lost_ = "the device has stopped";
  } else if (watch_.is_silent(device().pump().blocks(), static_cast<std::int64_t>(length_ns),
                              steady_clock_ns())) {
    lost_ = "the device has asked for no block for 0.8 s";
  }
  if (!lost_.empty() && format_.api == kPortAudioJack) JackTicket::server_has_gone();
}

AudioStatus PortAudioStream::status() {
  using State = AudioStatus::State;
  if (lost_.empty()) look();
  const LoadMeter::Figures load = device().pump().load();
  AudioStatus status;
  status.state = !lost_.empty() ? State::lost : is_started_ ? State::running : State::stopped;
  status.reason = lost_;
  status.blocks = device().pump().blocks();
  status.xruns = device().xruns();
  status.overruns = load.overruns;
  status.load = load.load;
  status.load_p99 = load.p99;
  status.load_max = load.max;
  return status;
}

OpenedStream open_device(AudioConfig config, const FoundDevice& device, AudioClient& client) {
  if (config.rate_hz == 0) config.rate_hz = device.info.rate_hz;
  auto opened = std::make_shared<PortAudioDevice>(client, config.rate_hz, config.channels);
  if (const auto result = opened->open(config, device); !result) return result.error();
  const PaStreamInfo* const info = Pa_GetStreamInfo(opened->stream());
  AudioFormat format;
  format.api = device.info.api;
  format.device = device.info.name;
  format.rate_hz = config.rate_hz;
  format.channels = static_cast<int>(config.channels.size());
  format.latency_s = info == nullptr ? -1 : info->outputLatency;
  if (!(format.latency_s >= 0 && format.latency_s <= kMostLatencySeconds)) format.latency_s = -1;
  format.block_frames = config.block_frames;
  if (config.block_frames == 0) {  // a guess, until the first block tells
    const double frames = std::max(format.latency_s, 0.0) * format.rate_hz;
    format.block_frames = std::clamp(static_cast<int>(frames), 16, kMaxAudioBlock);
  }
  return std::unique_ptr<AudioStream>(new PortAudioStream(std::move(opened), std::move(format)));
}

}  // namespace

OpenedStream open_portaudio_stream(const AudioConfig& config, const FoundDevice& device,
                                   AudioClient& client) {
  const int most = *std::max_element(config.channels.begin(), config.channels.end());
  if (most > device.info.outputs) {
    return fail(ErrorCode::value_out_of_range, "there is no channel " + std::to_string(most) +
                                                   ": '" + device.info.name + "' has " +
                                                   std::to_string(device.info.outputs));
  }
  const auto opened = std::make_shared<std::unique_ptr<OpenedStream>>();
  const auto outcome = run_portaudio(kOpensWithin, [opened, config, device, &client] {
    *opened = std::make_unique<OpenedStream>(open_device(config, device, client));
  });
  if (outcome == PatientCall::Outcome::done) return std::move(**opened);
  return fail(ErrorCode::io_failed, outcome == PatientCall::Outcome::hangs
                                        ? "the device does not answer"
                                        : kPortAudioHangs);
}

}  // namespace knotwave::io
