// SPDX-License-Identifier: MIT
// What may come out of a MIDI cable: music, everything else the specification knows, and what no
// specification allows.
#pragma once
#include <cstdint>
#include <vector>

#include "knotwave/base/random.h"

namespace knotwave::endurance {

class CableBytes {
 public:
  CableBytes(std::uint64_t seed, std::uint32_t cable) : random_{seed, cable, 7200} {}

  /// A few messages, or none at all but bytes, behind what is in `bytes`.
  void add_phrase(std::vector<std::uint8_t>& bytes);

 private:
  std::uint64_t bits() { return random_.bits(draw_++); }
  int below(int end) { return static_cast<int>(bits() % static_cast<std::uint64_t>(end)); }
  bool chance(int one_in) { return below(one_in) == 0; }

  void put(int byte);
  void channel_message(int status, int one, int two);
  void notes();
  void expression();
  void pedals();
  void program();
  void registered_parameter();
  void mode();
  void sysex();
  void system_common();
  void noise();

  base::RandomStream random_;
  std::uint64_t draw_ = 0;
  std::vector<std::uint8_t>* out_ = nullptr;
  int running_ = 0;  ///< status that need not be sent again
};

}  // namespace knotwave::endurance
