// SPDX-License-Identifier: MIT
// Control voltage out of an audio interface, a constant time after what is heard.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "knotwave/base/spsc_ring.h"
#include "knotwave/engine/midi_clock.h"
#include "knotwave/io/audio_device.h"

#include "cv_player.h"
#include "env_input.h"
#include "planner.h"
#include "stream_opener.h"

namespace knotwave::env {

/// The calibration that the options name; empty without. Errors: those of reading and parsing.
Result<std::vector<engine::VoltageChannel>> read_calibration(const EnvOptions& options);

/// "event 1 of 'Four voltages' goes to channel 5": what asks for the highest audio channel.
std::string highest_channel_text(const EnvInput& input);

class CvStream final : public PlannerListener, private io::AudioClient {
 public:
  /// Opens the device and starts. Errors: those of AudioStream and CvPlayer.
  static Result<std::unique_ptr<CvStream>> open(const EnvOptions& options, const EnvInput& input);
  ~CvStream() override;

  /// [the planner's thread]
  void heard(const base::MidiEvent& event, std::int64_t time_ns) noexcept override;
  /// Every channel goes to 0 V; is_silent() tells when it is there. [control]
  void ramp_out() { must_ramp_out_ = true; }
  bool is_silent() const { return is_lost_ || is_silent_; }
  /// "jack 'system', 48000 Hz, channels 1 to 4". [control]
  std::string device_text() const;
  /// What there is to tell: why the device is lost, that it is back. A lost one is looked for once
  /// a second; what was held plays on, and ramps in again. Call it some ten times a second.
  /// [control]
  std::string look();

 private:
  struct Heard {
    base::MidiEvent event;  ///< without system exclusive
    std::int64_t time_ns = 0;
  };
  CvStream(const EnvOptions& options, const EnvInput& input) : options_(options), input_(input) {
    out_.fill(nullptr);
  }
  Result<void> start(std::unique_ptr<io::AudioStream> stream);
  Result<void> make_player(double rate_hz);
  void process(const io::AudioBlock& block) KNOTWAVE_RT override;
  void play_until(std::size_t end, const io::AudioBlock& block) KNOTWAVE_RT;
  void handle(const Heard& heard) KNOTWAVE_RT;

  static constexpr std::size_t kMostHeard = 4096;
  static constexpr std::int64_t kPlannerNs = 2'000'000;  ///< what the planner takes at most

  const EnvOptions& options_;
  const EnvInput& input_;
  io::AudioConfig audio_;
  engine::VoltageConfig voltage_;
  synth::StreamOpener opener_;
  bool is_lost_ = false;
  std::int64_t next_try_ns_ = 0;
  std::unique_ptr<CvPlayer> player_;
  base::SpscRing<Heard> ring_{kMostHeard};
  std::array<engine::MidiClock, io::kMaxMidiPorts> clocks_;
  double rate_hz_ = 48000;
  bool has_front_ = false;
  Heard front_;
  std::size_t at_ = 0;  ///< frame of the block that is played next
  std::array<float*, 256> out_;
  std::atomic<bool> must_ramp_out_{false}, is_silent_{false}, is_overrun_{false};
  bool is_ramping_ = false;
  std::unique_ptr<io::AudioStream> stream_;  ///< goes first
};

}  // namespace knotwave::env
