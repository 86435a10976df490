// SPDX-License-Identifier: MIT
// What a MIDI input holds down, so that it can be let go when the cable is pulled.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "knotwave/base/midi_event.h"

namespace knotwave::synth {

class PortNotes {
 public:
  /// The most that is let go: three pedals and 128 keys of 16 channels.
  static constexpr std::size_t kMostHeld = std::size_t{16} * (3 + 128);

  /// A message of the port. [any], one thread at a time; nothing here waits or allocates.
  void heard(const base::MidiEvent& event) noexcept;
  /// Calls send(bytes) with what ends all that is held: pedals up, note-offs. Nothing is held
  /// then.
  template <class Send>
  void release(Send&& send) noexcept {
    for (int channel = 0; channel < 16; ++channel) {
      for (std::size_t i = 0; i < kPedals.size(); ++i) {
        if (take(pedals_[static_cast<std::size_t>(channel)], static_cast<int>(i))) {
          send(static_cast<std::uint8_t>(0xB0 | channel), kPedals[i], std::uint8_t{0});
        }
      }
      for (int key = 0; key < 128; ++key) {
        if (take(half(channel, key), key & 63)) {
          send(static_cast<std::uint8_t>(0x80 | channel), static_cast<std::uint8_t>(key),
               std::uint8_t{64});
        }
      }
    }
  }

 private:
  static constexpr std::array<std::uint8_t, 3> kPedals = {64, 66, 69};  ///< those that hold notes

  static bool take(std::uint64_t& bits, int bit) noexcept {
    const bool is_set = (bits >> bit & 1) != 0;
    bits &= ~(std::uint64_t{1} << bit);
    return is_set;
  }
  std::uint64_t& half(int channel, int key) noexcept {
    return keys_[2 * static_cast<std::size_t>(channel) + static_cast<std::size_t>(key >> 6)];
  }

  std::array<std::uint64_t, 32> keys_{};
  std::array<std::uint64_t, 16> pedals_{};
};

}  // namespace knotwave::synth
