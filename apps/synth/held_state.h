// SPDX-License-Identifier: MIT
// What a performance has set and holds: enough to go on in another engine, or in a program started
// anew, as if nothing had happened.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "knotwave/engine/journal.h"
#include "knotwave/engine/live_message.h"

namespace knotwave::synth {

class HeldState {
 public:
  HeldState();
  /// What happened, in order.
  void add(const engine::JournalRecord& record);
  /// What brings a fresh engine to this state: tempo, then each channel's controllers, program,
  /// registered parameters, bend, pressure and targets, then its keys that are down.
  std::vector<engine::LiveMessage> messages() const;

 private:
  struct Channel {
    std::array<std::int16_t, 128> controllers;      ///< -1: as it was
    std::array<std::uint8_t, 128> keys{};           ///< velocity; 0: up
    std::map<int, std::pair<int, int>> registered;  ///< RPN to data MSB and LSB; -1: not sent
    std::map<int, double> targets;
    int rpn = -1;  ///< selected; -1: none, or a non-registered one
    int program = -1, pressure = -1, bend = -1;
  };
  void add_midi(const std::uint8_t* bytes);
  void choke(const engine::JournalRecord& record);
  void add_controller(Channel& channel, int number, int value);
  void reset_controllers(Channel& channel);
  void add_channel(int number, std::vector<engine::LiveMessage>& messages) const;

  std::array<Channel, 16> channels_;
  double tempo_ = 0;
};

/// Messages as words for an environment variable, and back. What is no message is left out.
std::string text_of(const std::vector<engine::LiveMessage>& messages);
std::vector<engine::LiveMessage> messages_in(std::string_view text);

}  // namespace knotwave::synth
