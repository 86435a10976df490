// SPDX-License-Identifier: MIT
// A knob's moves from MIDI inputs, as a recording.
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "knotwave/base/spsc_ring.h"
#include "knotwave/io/audio_device.h"
#include "knotwave/io/midi_file.h"
#include "knotwave/io/midi_input.h"

#include "capture.h"
#include "env_input.h"
#include "planner.h"
#include "status.h"

namespace knotwave::env {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kLookNs = 100'000'000;
constexpr std::size_t kMostWaiting = 1 << 13;  // for 20 ms, at most

void tell(const std::string& line) {
  std::fprintf(stderr, "knotwave-env: %s\n", io::printable(line, 400).c_str());
}

/// Channel messages of all ports on their way to the thread that records.
class Ear final : public io::MidiListener {
 public:
  explicit Ear(std::int64_t begin_ns) : begin_ns_(begin_ns) {}

  void message(const base::MidiEvent& event, std::int64_t time_ns) noexcept override {
    if (event.bytes[0] < 0x80 || event.bytes[0] >= 0xF0) return;
    base::MidiEvent heard = event;
    heard.time = sample_time(time_ns, begin_ns_);
    Queue& queue = *queues_[event.port % queues_.size()];
    if (!queue.push(heard)) dropped_.fetch_add(1, std::memory_order_relaxed);
  }
  void port_lost(int) noexcept override {}  // a knob stays where it is

  /// Calls take(event) with all that came, each port's in order.
  template <class Take>
  void drain(Take&& take) {
    base::MidiEvent event;
    for (auto& queue : queues_) {
      while (queue->pop(event)) take(event);
    }
  }
  std::int64_t dropped() const { return dropped_; }

 private:
  using Queue = base::SpscRing<base::MidiEvent>;
  static std::array<std::unique_ptr<Queue>, io::kMaxMidiPorts> queues() {
    std::array<std::unique_ptr<Queue>, io::kMaxMidiPorts> all;
    for (auto& queue : all) queue = std::make_unique<Queue>(kMostWaiting);
    return all;
  }

  const std::int64_t begin_ns_;
  std::array<std::unique_ptr<Queue>, io::kMaxMidiPorts> queues_ = queues();
  std::atomic<std::int64_t> dropped_{0};
};

class LiveCapture {
 public:
  explicit LiveCapture(const EnvOptions& options)
      : options_(options),
        begin_ns_(io::steady_clock_ns()),
        ear_(begin_ns_),
        recorder_(options.capture.value, options.channel) {}

  Result<void> open() {
    io::MidiInputConfig config;
    config.api = options_.midi_api == "rtmidi-jack" ? "jack" : options_.midi_api;
    config.ports = options_.midi_in;
    config.left_out = kOutputClient;
    config.client_name = "Knotwave-env-in";
    auto inputs = io::MidiInputs::open(config, ear_);
    if (!inputs) return inputs.error();
    inputs_ = std::move(*inputs);
    for (const std::string& note : inputs_->notes()) tell(note);
    return {};
  }

  void run(const std::atomic<int>& signals) {
    if (!options_.quiet) {
      tell("listens for " + midi_value_text(options_.capture.value) + " on " + inputs_text() +
           "; Ctrl-C ends and saves");
    }
    std::int64_t look_ns = begin_ns_, show_ns = begin_ns_;
    while (signals == 0 && !is_over()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      take();
      const std::int64_t now_ns = io::steady_clock_ns();
      if (now_ns >= look_ns) {
        inputs_->poll();
        look_ns = now_ns + kLookNs;
      }
      if (now_ns >= show_ns) {
        show();
        show_ns = now_ns + kSecondNs;
      }
    }
    end_ns_ = io::steady_clock_ns();
    inputs_.reset();
    take();
  }

  Result<Recording> recording() const {
    const CaptureOptions& capture = options_.capture;
    if (ear_.dropped() > 0) tell(std::to_string(ear_.dropped()) + " messages had no room");
    if (recorder_.elsewhere() > 0 && !options_.quiet) {
      tell(std::to_string(recorder_.elsewhere()) + " values of other channels or inputs left out");
    }
    if (recorder_.heard() == 0) {
      return fail(ErrorCode::unknown_name, "no " + midi_value_text(capture.value) +
                                               " was heard; what came: " + others_.text());
    }
    const double units_per_s = capture.beats ? options_.bpm / 60 : 1;
    const base::SampleTime end = sample_time(end_ns_, begin_ns_);
    return recording_of(
        capture, recorder_,
        {static_cast<double>(end.sample), kClockHz / units_per_s, capture.ramp_s * units_per_s});
  }

 private:
  bool is_over() const {
    return options_.duration_s > 0 &&
           static_cast<double>(io::steady_clock_ns() - begin_ns_) >= options_.duration_s * 1e9;
  }
  void take() {
    ear_.drain([this](const base::MidiEvent& event) {
      recorder_.hear(event);
      others_.hear(event);
    });
  }
  std::string inputs_text() const {
    std::string text;
    for (const io::MidiPortStatus& port : inputs_->ports()) {
      if (port.is_open) text += (text.empty() ? "'" : ", '") + port.name + "'";
    }
    return text.empty() ? "no input yet" : text;
  }
  void show() {
    if (options_.quiet || recorder_.heard() == shown_) return;
    shown_ = recorder_.heard();
    tell(midi_value_text(options_.capture.value) + " ch" + std::to_string(recorder_.channel()) +
         " " + std::to_string(recorder_.moves().back().step) + ", " + std::to_string(shown_) +
         " values");
  }

  const EnvOptions& options_;
  const std::int64_t begin_ns_;
  std::int64_t end_ns_ = 0;
  Ear ear_;
  std::unique_ptr<io::MidiInputs> inputs_;
  engine::KnobRecorder recorder_;
  ValueList others_;
  std::int64_t shown_ = 0;
};

}  // namespace

Result<Recording> record_midi_inputs(const EnvOptions& options, const std::atomic<int>& signals) {
  LiveCapture capture(options);
  if (const auto opened = capture.open(); !opened) return opened.error();
  capture.run(signals);
  return capture.recording();
}

}  // namespace knotwave::env
