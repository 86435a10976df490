// SPDX-License-Identifier: MIT
#include "knotwave/engine/knob_recorder.h"

#include <algorithm>
#include <utility>

namespace knotwave::engine {
namespace {

constexpr std::int64_t kPairSamples = 480;

template <std::size_t... i>
std::array<MidiValue, sizeof...(i)> one_each(const MidiValueSpec& spec, std::index_sequence<i...>) {
  return {((void)i, MidiValue(spec))...};
}

bool is_one_value(base::SampleTime upper, base::SampleTime lower) {
  return lower.sample - upper.sample <= kPairSamples;
}

}  // namespace

KnobRecorder::KnobRecorder(const MidiValueSpec& value, int channel)
    : values_(one_each(value, std::make_index_sequence<16>())),
      elsewhere_value_(value),
      channel_(channel) {}

void KnobRecorder::hear(const base::MidiEvent& event) {
  if (event.bytes[0] < 0x80 || event.bytes[0] >= 0xF0) return;
  const int channel = event.channel() + 1;
  const bool may_be_it = channel_ == 0 || channel == channel_;
  if (!may_be_it || (port_ >= 0 && event.port != port_)) {
    elsewhere_ += elsewhere_value_.hear(event.bytes) ? 1 : 0;
    return;
  }
  MidiValue& value = values_[static_cast<std::size_t>(channel - 1)];
  if (!value.hear(event.bytes)) return;
  channel_ = channel;
  port_ = event.port;
  ++heard_;
  take(event.time, value);
}

void KnobRecorder::take(base::SampleTime time, const MidiValue& value) {
  const base::SampleTime last_time = time_;
  time_ = std::max(time, last_time);
  if (value.completes() && size_before_ > 0 && is_one_value(last_time, time_)) {
    moves_.resize(size_before_ - 1);
    moves_.push_back(last_before_);
  } else if (value.completes() && is_one_value(last_time, time_)) {
    moves_.clear();
  }
  size_before_ = moves_.size();
  if (!moves_.empty()) last_before_ = moves_.back();
  commit(time_, value.step());
}

void KnobRecorder::commit(base::SampleTime time, int step) {
  if (!moves_.empty() && moves_.back().time == time) moves_.pop_back();
  if (!moves_.empty() && moves_.back().step == step) {
    moves_.back().last_told = time;
    return;
  }
  if (moves_.size() >= kMostKnobMoves) {
    ++dropped_;
    return;
  }
  moves_.push_back({time, time, step});
}

}  // namespace knotwave::engine
