// SPDX-License-Identifier: MIT
// Blocks; the table of parameters is in envelope_plugin_info.cpp, the text in
// envelope_plugin_state.cpp.
#include "envelope_plugin.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "knotwave/base/fit_input.h"
#include "knotwave/engine/channel_state.h"
#include "knotwave/engine/map_slots.h"
#include "knotwave/plugins/plugin_list.h"

namespace knotwave::plugins {
namespace {

using engine::Event;

/// Told before the generator must play: half of what it has room for.
constexpr std::size_t kMostTold = engine::EnvelopeGenerator::kMostEvents / 2;
/// A patch that leaves is at rest by then: a parameter's selection is undone after half a second.
constexpr double kMostSecondsToLeave = 1;

bool ends_something(const base::MidiEvent& event) KNOTWAVE_RT {
  switch (event.status()) {
    case base::MidiStatus::note_off:
      return true;
    case base::MidiStatus::note_on:
      return event.bytes[2] == 0;
    case base::MidiStatus::control_change:
      return event.bytes[1] >= engine::kAllSoundOff;
    default:
      return false;
  }
}

}  // namespace

EnvelopePlugin::EnvelopePlugin() : envelope_info_(envelope_info()), sent_(kMostMessages) {
  static_cast<void>(load_preset(0));  // a shipped patch, as the tests see to
}

EnvelopePlugin::~EnvelopePlugin() {
  drop_arriving();
  for (Playing* one : {playing_, leaving_}) {
    if (one != nullptr) arriving_.release(one);
  }
  arriving_.collect();
}

// Control.

Result<std::unique_ptr<EnvelopePlugin::Playing>> EnvelopePlugin::make_playing(
    const engine::EnvelopePatchSpec& spec, double rate_hz) {
  auto playing = std::make_unique<Playing>();
  auto program = engine::EnvelopePatchProgram::create(spec);
  if (!program) return program.error();
  playing->program = *std::move(program);
  engine::EnvelopeGeneratorConfig config;
  config.rate_hz = rate_hz;
  config.lead_s = 0;
  const engine::EnvelopePatchProgram* const patches[] = {playing->program.get()};
  auto generator = engine::EnvelopeGenerator::create(config, patches);
  if (!generator) return generator.error();
  playing->generator = *std::move(generator);
  return playing;
}

Result<void> EnvelopePlugin::load(engine::EnvelopePatchSpec spec) {
  auto playing = make_playing(spec, rate_hz_);
  if (!playing) return playing.error();
  spec_ = std::move(spec);
  if (is_active()) arriving_.publish(*std::move(playing));
  return {};
}

Result<void> EnvelopePlugin::activate(double rate_hz) {
  auto playing = make_playing(spec_, rate_hz);
  if (!playing) return playing.error();
  deactivate();
  rate_hz_ = rate_hz;
  song_.reset(rate_hz);
  side_chain_.reset();
  set_side_chain();
  now_ = 0;
  sent_count_ = 0;
  gate_is_open_ = must_say_again_ = false;
  values_.forget_heard();
  arriving_.publish(*std::move(playing));
  playing_ = arriving_.acquire();
  leaves_until_ = static_cast<std::int64_t>(kMostSecondsToLeave * rate_hz_);
  return {};
}

/// What was played is kept: it ends its notes in the first blocks after the next activate().
void EnvelopePlugin::deactivate() {
  drop_arriving();
  if (playing_ == nullptr) return;
  if (playing_->generator->now() == 0) {
    arriving_.release(std::exchange(playing_, nullptr));
  } else {
    if (leaving_ != nullptr) arriving_.release(leaving_);
    leaving_ = std::exchange(playing_, nullptr);
    leaving_->generator->go_to_rest();
  }
  sent_count_ = 0;
  arriving_.collect();
}

void EnvelopePlugin::drop_arriving() {
  for (Playing* one = arriving_.acquire(); one != nullptr; one = arriving_.acquire()) {
    arriving_.release(one);
  }
}

void EnvelopePlugin::set_parameter(std::size_t place, double value) KNOTWAVE_RT {
  values_.set(place, value);
}
double EnvelopePlugin::parameter(std::size_t place) const KNOTWAVE_RT { return values_.get(place); }

// A block.

void EnvelopePlugin::begin(const Block& block) KNOTWAVE_RT {
  block_ = block;
  sent_count_ = told_ = 0;
  played_ = listened_ = 0;
  if (std::exchange(must_say_again_, false)) say_again();
  base_ = playing_->generator->now();
  take_patch();
  play_leaving();
  values_.take_news([this](std::size_t place, double value) { tell_parameter(place, value, 0); });
  follow_gate(0);
}

/// The patch that was before ends its notes and comes to rest beside the new one, which says its
/// values again when that is done.
void EnvelopePlugin::play_leaving() KNOTWAVE_RT {
  if (leaving_ == nullptr) return;
  engine::EnvelopeGenerator& generator = *leaving_->generator;
  sink_base_ = generator.now();
  is_leaving_ = true;
  generator.advance(sink_base_ + static_cast<std::int64_t>(block_.frames), *this);
  is_leaving_ = false;
  if (!generator.is_at_rest() && now_ < leaves_until_) return;
  arriving_.release(std::exchange(leaving_, nullptr));
  must_say_again_ = true;
}

void EnvelopePlugin::take_patch() KNOTWAVE_RT {
  if (leaving_ != nullptr) return;
  Playing* next = arriving_.acquire();
  if (next == nullptr) return;
  for (Playing* newer = arriving_.acquire(); newer != nullptr; newer = arriving_.acquire()) {
    arriving_.release(std::exchange(next, newer));
  }
  playing_->generator->go_to_rest();
  leaving_ = std::exchange(playing_, next);
  leaves_until_ = now_ + static_cast<std::int64_t>(kMostSecondsToLeave * rate_hz_);
  base_ = playing_->generator->now();
  gate_is_open_ = false;
  song_.tell_again();
  for (std::size_t place = 0; place < table().size(); ++place) {
    if (values_.heard(place) == table()[place].initial) continue;
    tell_parameter(place, values_.heard(place), 0);
  }
}

void EnvelopePlugin::say_again() KNOTWAVE_RT {
  for (std::size_t port = 0; port < playing_->generator->ports().size(); ++port) {
    playing_->generator->say_again(static_cast<int>(port));
  }
}

void EnvelopePlugin::tell(Event event, std::int64_t sample) KNOTWAVE_RT {
  const auto last = static_cast<std::int64_t>(std::max<std::size_t>(block_.frames, 1) - 1);
  sample = std::min(sample, last);  // beyond it is a host's error
  if (told_ >= kMostTold) play_until(sample);
  event.midi.time.sample = base_ + sample;
  playing_->generator->tell(event);
  ++told_;
}

void EnvelopePlugin::tell(int slot, double number, std::int64_t sample) KNOTWAVE_RT {
  Event event;
  event.kind = Event::Kind::set_target;
  event.slot = static_cast<std::uint16_t>(slot);
  event.number = number;
  event.every_channel = true;
  tell(event, sample);
}

void EnvelopePlugin::tell_parameter(std::size_t place, double value,
                                    std::int64_t sample) KNOTWAVE_RT {
  const auto within = [place](std::size_t first) { return place >= first && place < first + 8; };
  if (place == time) {
    for (int i = 0; i < engine::kMaxVoiceEnvelopes; ++i) {
      tell(engine::kSlotEnvelopeTime + i, value, sample);
    }
  } else if (place == rate) {
    for (int i = 0; i < engine::kMaxLfos; ++i) tell(engine::kSlotLfoRate + i, value, sample);
  } else if (place == source) {
    side_chain_.reset();
    tell(engine::kSlotGateByHand, gate_source() == GateSource::patch ? 0 : 1, sample);
    if (gate_source() == GateSource::patch) gate_is_open_ = false;
    follow_gate(sample);
  } else if (place == gate) {
    follow_gate(sample);
  } else if (place == threshold || place == hysteresis || place == hold) {
    set_side_chain();
  } else if (within(first_depth)) {
    tell(engine::kSlotOutputDepth + static_cast<int>(place - first_depth), value - 1, sample);
  } else if (within(first_offset)) {
    tell(engine::kSlotOutputOffset + static_cast<int>(place - first_offset), value, sample);
  } else if (within(first_macro)) {
    tell(engine::kSlotFree + static_cast<int>(place - first_macro), value, sample);
  }
}

void EnvelopePlugin::set_side_chain() KNOTWAVE_RT {
  side_chain_.set(values_.heard(threshold), values_.heard(hysteresis), values_.heard(hold) * 1e-3,
                  rate_hz_);
}

void EnvelopePlugin::add(const Event& event) KNOTWAVE_RT {
  hear_side_chain(event.time().sample);
  if (event.kind != Event::Kind::midi || !event.every_channel) {
    return tell(event, event.time().sample);
  }
  Event one = event;  // its keys have no numbers
  for (int channel = 0; channel < 16; ++channel) {
    one.midi.bytes[0] = static_cast<std::uint8_t>((event.midi.bytes[0] & 0xF0) | channel);
    tell(one, event.time().sample);
  }
}

void EnvelopePlugin::add_parameter(std::size_t place, double value,
                                   std::int64_t sample) KNOTWAVE_RT {
  if (place >= table().size()) return;
  hear_side_chain(sample);
  tell_parameter(place, values_.set_heard(place, value), sample);
}

void EnvelopePlugin::add_transport(const Transport& transport, std::int64_t sample) KNOTWAVE_RT {
  hear_side_chain(sample);
  const HostSong::News news = song_.follow(transport, now_ + sample);
  if (news.tempo) {
    Event event;
    event.kind = Event::Kind::tempo;
    event.microseconds_per_quarter = song_.microseconds();
    tell(event, sample);
  }
  if (news.stopped) tell(engine::kSlotSongStops, 0, sample);
  if (news.place) tell(engine::kSlotSong, transport.quarters, sample);
  follow_gate(sample);
}

void EnvelopePlugin::hear_side_chain(std::int64_t until) KNOTWAVE_RT {
  const std::int64_t last = std::min(until, static_cast<std::int64_t>(block_.frames));
  if (gate_source() != GateSource::side_chain) {
    listened_ = std::max(listened_, last);
    return;
  }
  const float* const left = block_.in[0];
  const float* const right = block_.in[1];
  for (; listened_ < last; ++listened_) {
    const bool moved = side_chain_.hear(left == nullptr ? 0 : left[listened_],
                                        right == nullptr ? 0 : right[listened_]);
    if (moved) follow_gate(listened_);
  }
}

bool EnvelopePlugin::wants_gate() const KNOTWAVE_RT {
  switch (gate_source()) {
    case GateSource::side_chain:
      return side_chain_.is_open();
    case GateSource::song:
      return song_.is_playing();
    case GateSource::hand:
      return values_.heard(gate) != 0;
    case GateSource::patch:
      break;
  }
  return false;
}

void EnvelopePlugin::follow_gate(std::int64_t sample) KNOTWAVE_RT {
  if (wants_gate() == gate_is_open_) return;
  gate_is_open_ = !gate_is_open_;
  tell(engine::kSlotGate, gate_is_open_ ? values_.heard(velocity) : 0, sample);
}

void EnvelopePlugin::play_until(std::int64_t sample) KNOTWAVE_RT {
  if (sample <= played_) return;
  sink_base_ = base_;
  playing_->generator->advance(base_ + sample, *this);
  played_ = sample;
  told_ = 0;
}

void EnvelopePlugin::render() KNOTWAVE_RT {
  const auto frames = static_cast<std::int64_t>(block_.frames);
  hear_side_chain(frames);
  play_until(frames);
  for (std::size_t c = playing_->generator->voltage_channels(); c < kVoltages; ++c) {
    float* const out = block_.out[kAudioChannels + c];
    if (out != nullptr) std::fill_n(out, block_.frames, 0.0F);
  }
  pass_through();
  now_ += frames;
}

void EnvelopePlugin::pass_through() KNOTWAVE_RT {
  for (std::size_t channel = 0; channel < kAudioChannels; ++channel) {
    float* const out = block_.out[channel];
    const float* const in = block_.in[channel];
    if (out == nullptr) continue;
    if (in == nullptr) {
      std::fill_n(out, block_.frames, 0.0F);
    } else {
      std::transform(in, in + block_.frames, out, base::fit_input<float>);
    }
  }
}

void EnvelopePlugin::reset() KNOTWAVE_RT {
  playing_->generator->end_all();
  side_chain_.reset();
  gate_is_open_ = false;
}

// What generators send.

/// Ports and patches take turns within a block: each message goes to its place.
void EnvelopePlugin::midi(int /*port*/, const base::MidiEvent& event) KNOTWAVE_RT {
  const std::size_t room = ends_something(event) ? kMostMessages : kMostMessages - kKeptForEnds;
  if (sent_count_ >= room) {
    must_say_again_ = true;
    return;
  }
  base::MidiEvent told = event;
  told.time.sample -= sink_base_;
  std::size_t at = sent_count_++;
  for (; at > 0 && told.time < sent_[at - 1].time; --at) sent_[at] = sent_[at - 1];
  sent_[at] = told;
}

void EnvelopePlugin::volts(int channel, std::int64_t first,
                           std::span<const double> values) KNOTWAVE_RT {
  const auto place = static_cast<std::size_t>(channel);
  if (is_leaving_ || place >= kVoltages) return;
  float* const out = block_.out[kAudioChannels + place];
  if (out == nullptr) return;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double volts = values[i] == values[i] ? values[i] : 0;
    out[static_cast<std::size_t>(first - base_) + i] =
        static_cast<float>(std::clamp(volts / kVoltsFullScale, -1.0, 1.0));
  }
}

}  // namespace knotwave::plugins
