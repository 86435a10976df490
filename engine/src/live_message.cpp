// SPDX-License-Identifier: MIT
#include "knotwave/engine/live_message.h"

#include <algorithm>

namespace knotwave::engine {

LiveMessage live_message(const base::MidiEvent& event, std::int64_t time_ns) KNOTWAVE_RT {
  LiveMessage message;
  message.time_ns = time_ns;
  std::copy_n(event.bytes, 3, message.bytes);
  message.port = event.port;
  if (event.sysex != nullptr && event.sysex_size <= LiveMessage::kMaxSysex) {
    std::copy_n(event.sysex, event.sysex_size, message.sysex.begin());
    message.sysex_size = static_cast<std::uint8_t>(event.sysex_size);
  }
  return message;
}

}  // namespace knotwave::engine
