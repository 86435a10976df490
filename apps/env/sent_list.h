// SPDX-License-Identifier: MIT
// All that a generator sent, in order of time: what a dry run writes, hashes and draws.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "knotwave/engine/envelope_generator.h"

namespace knotwave::env {

/// A message to a port, or a number to an OSC address.
struct SentMessage {
  base::SampleTime time;
  int port = -1;                      ///< -1: OSC
  std::uint8_t bytes[3] = {0, 0, 0};  ///< F0 and two zeros: system exclusive
  std::vector<std::uint8_t> sysex;    ///< without F0 and F7
  int patch = -1, output = -1;        ///< OSC
  double number = 0;                  ///< OSC

  std::vector<std::uint8_t> wire() const;  ///< as it goes through a cable; OSC: nothing
};

/// Time as text, in seconds with 9 digits, rounded towards 0: "0.500000000".
std::string seconds_text(base::SampleTime time, int rate_hz);

class SentList final : public engine::GeneratorSink {
 public:
  void midi(int port, const base::MidiEvent& event) KNOTWAVE_RT override;
  void osc(int patch, int output, base::SampleTime time, double value) KNOTWAVE_RT override;

  /// By time; of one time, by port and in the order they were sent. Call it when all is in.
  void sort();
  std::span<const SentMessage> messages() const { return messages_; }
  /// SHA-256 of time, port and bytes or number of every message.
  std::string sha256() const;

 private:
  std::vector<SentMessage> messages_;
};

}  // namespace knotwave::env
