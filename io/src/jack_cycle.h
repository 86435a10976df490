// SPDX-License-Identifier: MIT
// What JACK says of the cycle that is being processed, by our clock.
#pragma once
#include <jack/jack.h>

#include "knotwave/io/audio_device.h"

#include "cycle_clock.h"

namespace knotwave::io {

/// Tells `clock` of the cycle. In a process callback. [audio]
inline void follow_cycle(jack_client_t* client, jack_nframes_t frames,
                         CycleClock& clock) KNOTWAVE_RT {
  jack_nframes_t frame_time = 0;
  jack_time_t begin_us = 0, next_us = 0;
  float period_us = 0;
  const bool is_known =
      jack_get_cycle_times(client, &frame_time, &begin_us, &next_us, &period_us) == 0;
  if (!is_known) frame_time = jack_last_frame_time(client);
  // JACK's clock need not be ours, but the age of the cycle is the same by both, read at one time:
  // whoever was interrupted in between reads again.
  constexpr std::int64_t kTogetherNs = 20'000;
  std::int64_t now_ns = 0, age_us = 0;
  for (int attempt = 0; attempt < 3; ++attempt) {
    now_ns = steady_clock_ns();
    age_us = is_known ? static_cast<std::int64_t>(jack_get_time() - begin_us) : 0;
    if (steady_clock_ns() - now_ns < kTogetherNs) break;
  }
  clock.advance({frame_time, age_us, frames}, now_ns);
}

}  // namespace knotwave::io
