// SPDX-License-Identifier: MIT
// The thread that plays live: what comes in moves the generator on, what it sends is handed to the
// sender with the time it is due.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "knotwave/base/spsc_ring.h"
#include "knotwave/engine/envelope_generator.h"
#include "knotwave/io/midi_input.h"
#include "knotwave/io/midi_queue.h"
#include "knotwave/io/midi_sender.h"
#include "knotwave/io/osc_output.h"
#include "knotwave/io/sleeper.h"

#include "port_notes.h"
#include "sent_files.h"

namespace knotwave::env {

/// Samples of the virtual clock since `begin_ns`, and back. [any]
base::SampleTime sample_time(std::int64_t time_ns, std::int64_t begin_ns) KNOTWAVE_RT;
std::int64_t steady_time(base::SampleTime time, std::int64_t begin_ns) KNOTWAVE_RT;

/// Hears what the planner heard, in order, on its thread: control voltage.
class PlannerListener {
 public:
  virtual ~PlannerListener() = default;
  virtual void heard(const base::MidiEvent& event, std::int64_t time_ns) noexcept = 0;
};

class Planner final : public io::MidiListener, private engine::GeneratorSink {
 public:
  struct Config {
    std::int64_t latency_ns = 2'000'000;  ///< from what is heard to what it makes
    bool monitor = false;
  };
  /// A message of the monitor; system exclusive only as a status.
  struct Shown {
    base::SampleTime time;
    int port = -1, patch = -1, output = -1;
    std::uint8_t bytes[3] = {0, 0, 0};
    double number = 0;
  };

  /// All must outlive it; `osc` and `listener` may be null. [control]
  Planner(const Config& config, engine::EnvelopeGenerator& generator, io::MidiSender& sender,
          io::OscOutput* osc, PlannerListener* listener, SentNames names);
  ~Planner() override;

  void start();
  /// Whoever hears this port came back: he is told every value again. [control]
  void say_again(int port) {
    again_ports_.fetch_or(1u << port);
    sleeper_.wake();
  }
  /// The generator goes to rest; is_at_rest() tells when it is there. [control]
  void go_to_rest() {
    must_rest_ = true;
    sleeper_.wake();
  }
  bool is_at_rest() const { return is_at_rest_; }

  /// As of a quarter of a second ago. [control]
  std::vector<engine::RouteStatus> routes() const;
  std::vector<Shown> take_shown();
  std::int64_t dropped_in() const { return dropped_in_; }  ///< heard, without room

  void message(const base::MidiEvent& event, std::int64_t time_ns) noexcept override;
  void port_lost(int port) noexcept override;

 private:
  struct Input {
    io::MidiQueue queue{4096, 65536};
    synth::PortNotes notes;
  };

  void run();
  void take_inputs(std::int64_t now_ns);
  void keep_sysex(base::MidiEvent& event);
  void step(std::int64_t now_ns);
  void show(const Shown& shown) noexcept;
  void flush_osc() noexcept;
  void midi(int port, const base::MidiEvent& event) KNOTWAVE_RT override;
  void osc(int patch, int output, base::SampleTime time, double value) KNOTWAVE_RT override;

  const Config config_;
  engine::EnvelopeGenerator& generator_;
  io::MidiSender& sender_;
  io::OscOutput* const osc_;
  PlannerListener* const listener_;
  const SentNames names_;

  std::array<Input, io::kMaxMidiPorts> inputs_;
  std::vector<std::uint8_t>
      kept_;  ///< system exclusive that the generator refers to, round and round
  std::size_t kept_end_ = 0;
  std::atomic<std::int64_t> dropped_in_{0};
  std::atomic<std::uint32_t> again_ports_{0};  ///< bit p: port p
  std::int64_t begin_ns_ = 0;                  ///< of the virtual clock
  std::int64_t stepped_ns_ = 0;                ///< the last step
  std::array<io::OscNumber, 64> bundle_;
  std::size_t bundled_ = 0;
  base::SampleTime bundle_time_;
  base::SpscRing<Shown> shown_{8192};

  mutable std::mutex mutex_;
  std::vector<engine::RouteStatus> routes_;
  io::Sleeper sleeper_;
  bool has_sent_ = false;  ///< to the sender, since it was woken
  std::atomic<bool> must_end_{false}, must_rest_{false}, is_at_rest_{false};
  std::thread thread_;
};

}  // namespace knotwave::env
