// SPDX-License-Identifier: MIT
#include "block_pump.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace knotwave::io {

BlockPump::BlockPump(AudioClient& client, double rate_hz, int channels)
    : client_(client), rate_hz_(rate_hz), outputs_(static_cast<std::size_t>(channels)) {}

// is_inside_ is raised before is_open_ is read, close() lowers is_open_ before it reads is_inside_:
// in the one order of both, either run() sees closed or close() sees inside.
void BlockPump::run(const Request& request) KNOTWAVE_RT {
  is_inside_.store(true);
  if (is_open_.load()) {
    const std::int64_t begin_ns = steady_clock_ns();
    call_client(request);
    const double length_ns = static_cast<double>(request.frames) / rate_hz_ * 1e9;
    if (request.has_deadline) {
      meter_.count(steady_clock_ns() - begin_ns, static_cast<std::int64_t>(length_ns));
    }
    blocks_.store(blocks_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  } else {
    for (float* output : request.outputs) std::fill_n(output, request.frames, 0.0F);
  }
  is_inside_.store(false, std::memory_order_release);
}

void BlockPump::close() noexcept {
  is_open_.store(false);
  while (is_inside_.load()) std::this_thread::sleep_for(std::chrono::microseconds(200));
}

void BlockPump::call_client(const Request& request) KNOTWAVE_RT {
  std::span<base::MidiEvent> midi = request.midi;
  for (int start = 0; start < request.frames; start += kMaxAudioBlock) {
    const int frames = std::min(kMaxAudioBlock, request.frames - start);
    for (std::size_t c = 0; c < outputs_.size(); ++c) outputs_[c] = request.outputs[c] + start;
    std::size_t due = 0;
    for (; due < midi.size() && midi[due].time.sample < start + frames; ++due) {
      midi[due].time.sample -= start;
    }
    const auto late_ns = static_cast<std::int64_t>(static_cast<double>(start) / rate_hz_ * 1e9);
    client_.process({.frame = request.frame + start,
                     .time_ns = request.time_ns + late_ns,
                     .outputs = outputs_,
                     .frames = frames,
                     .midi = midi.first(due)});
    midi = midi.subspan(due);
  }
}

}  // namespace knotwave::io
