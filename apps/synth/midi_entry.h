// SPDX-License-Identifier: MIT
// What every MIDI message goes through on its way to the engine: knobs that were learnt, clocks
// that become tempo and song position, and the memory of what a cable holds down.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "knotwave/engine/midi_clock.h"
#include "knotwave/engine/midi_learn.h"
#include "knotwave/io/midi_input.h"

#include "engine_gate.h"
#include "port_notes.h"

namespace knotwave::synth {

class MidiEntry {
 public:
  static constexpr std::size_t kMostExact = 4096;  ///< messages of one translated(); more are lost
  /// `gate` must outlive it.
  explicit MidiEntry(EngineGate& gate);

  /// A message of a cable, or its loss. [any], one thread at a time for each port.
  void heard(const base::MidiEvent& event, std::int64_t time_ns) noexcept;
  void lost(int port) noexcept;
  /// Of the stream's own port: what goes to the engine, what its clock tells included; times are
  /// offsets in a block that was asked for at `time_ns`. Valid until the next call. [audio]
  std::span<const engine::Event> translated(std::span<const base::MidiEvent> exact,
                                            std::int64_t time_ns, double rate_hz) KNOTWAVE_RT;
  /// Who was connected to the stream's own port went: what it holds ends with the next block. [any]
  void stream_sender_left() noexcept { has_sender_left_ = true; }
  /// Bit p: port p is not listened to; the stream's own port hears it, or will. [any]
  void leave_out(std::uint32_t ports) noexcept { left_out_ = ports; }
  /// Nothing is held any more, and every controller is back. [control]
  void forget() noexcept;
  /// The engine is another one: each clock tells it tempo and song position anew. [control]
  void tell_again() noexcept { must_tell_ = kEveryPort; }

  // Learning. [control]
  void use(engine::MidiLearn learn);
  /// The next controller that moves stands for `controller`. False: it cannot.
  bool learn(int controller);
  void cancel();
  bool is_learning();
  /// Knobs that have to be turned before they are picked up: "controller 21: turn it up".
  std::vector<std::string> to_turn();
  /// What was learnt since the last call; none: nothing.
  std::optional<engine::LearnSpec> news();

  /// Of the clock that came last; 0: none came.
  double clock_bpm() const { return bpm_; }
  double clock_jitter_ms() const { return jitter_ms_; }

 private:
  /// Of learn_. Held as long as a message takes, so it is worth a few tries, but an audio thread
  /// must not wait for a control thread that the system put aside.
  class Lock {
   public:
    Lock(std::atomic_flag& flag, int tries) noexcept : flag_(flag) {
      while (tries-- > 0 && !is_held_) is_held_ = !flag_.test_and_set(std::memory_order_acquire);
    }
    ~Lock() {
      if (is_held_) flag_.clear(std::memory_order_release);
    }
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;
    bool is_held() const noexcept { return is_held_; }

   private:
    std::atomic_flag& flag_;
    bool is_held_ = false;
  };
  static constexpr int kTries = 1000;                            ///< of threads that play
  static constexpr int kEndless = 1 << 30;                       ///< of the control thread
  static constexpr std::size_t kStreamPort = io::kMaxMidiPorts;  ///< the stream's own
  static constexpr std::uint32_t kEveryPort = ~std::uint32_t{0};

  static bool take_bit(std::atomic<std::uint32_t>& bits, std::size_t port) noexcept;
  PortNotes& notes_of(std::size_t port) noexcept;
  void follow_stream_sender() noexcept;
  engine::MidiLearn::Out learned(const base::MidiEvent& event) noexcept;
  /// What a message means to a port's clock; none: it is no clock's.
  std::optional<engine::MidiClock::News> follow_clock(const base::MidiEvent& event,
                                                      std::int64_t time_ns,
                                                      std::size_t port) noexcept;

  EngineGate& gate_;
  std::array<PortNotes, kStreamPort + 1> notes_;  ///< each of the thread that hears its port
  std::atomic<std::uint32_t> must_forget_{0};     ///< bit p: what port p held is over
  std::atomic<std::uint32_t> must_tell_{0};       ///< bit p: as tell_again()
  std::array<engine::MidiClock, kStreamPort + 1> clocks_;
  std::atomic<std::uint32_t> left_out_{0};
  std::atomic<float> bpm_{0}, jitter_ms_{0};
  std::atomic_flag lock_;  ///< of learn_
  std::optional<engine::MidiLearn> learn_;
  std::atomic<bool> has_learn_{false};
  std::vector<engine::Event> exact_;
  std::atomic<bool> has_sender_left_{false};
};

}  // namespace knotwave::synth
