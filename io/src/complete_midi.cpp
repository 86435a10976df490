// SPDX-License-Identifier: MIT
#include "complete_midi.h"

#include <algorithm>

namespace knotwave::io {
namespace {

bool are_data(std::span<const std::uint8_t> bytes) KNOTWAVE_RT {
  return std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t byte) { return byte < 0x80; });
}

}  // namespace

std::size_t message_size(std::uint8_t status) KNOTWAVE_RT {
  switch (status & 0xF0) {
    case 0x80:
    case 0x90:
    case 0xA0:
    case 0xB0:
    case 0xE0:
      return 3;
    case 0xC0:
    case 0xD0:
      return 2;
    default:
      break;
  }
  switch (status) {
    case 0xF2:
      return 3;
    case 0xF1:
    case 0xF3:
      return 2;
    case 0xF6:
    case 0xF8:
    case 0xFA:
    case 0xFB:
    case 0xFC:
    case 0xFE:
    case 0xFF:
      return 1;
    default:
      return 0;
  }
}

bool read_complete_midi(std::span<const std::uint8_t> bytes, base::MidiEvent& event) KNOTWAVE_RT {
  if (bytes.empty()) return false;
  if (bytes.front() == 0xF0) {
    if (bytes.size() < 2 || bytes.back() != 0xF7) return false;
    const auto data = bytes.subspan(1, bytes.size() - 2);
    if (!are_data(data)) return false;
    event.bytes[0] = 0xF0;
    event.bytes[1] = event.bytes[2] = 0;
    event.sysex = data.data();
    event.sysex_size = static_cast<std::uint32_t>(data.size());
    return true;
  }
  if (bytes.size() != message_size(bytes.front()) || !are_data(bytes.subspan(1))) return false;
  event.bytes[0] = bytes[0];
  event.bytes[1] = bytes.size() > 1 ? bytes[1] : std::uint8_t{0};
  event.bytes[2] = bytes.size() > 2 ? bytes[2] : std::uint8_t{0};
  event.sysex = nullptr;
  event.sysex_size = 0;
  return true;
}

}  // namespace knotwave::io
