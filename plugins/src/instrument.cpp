// SPDX-License-Identifier: MIT
#include "knotwave/plugins/instrument.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "knotwave/engine/channel_state.h"
#include "knotwave/plugins/factory.h"
#include "knotwave/plugins/plugin_list.h"

namespace knotwave::plugins {
namespace {

using engine::Event;

constexpr double kLeastBpm = 1, kMostBpm = 1000;
constexpr double kJumpQuarters = 1e-3;
constexpr double kMostQuarters = 1e9;
/// Nothing comes in but through process(): the rings of the live engine stay empty.
constexpr int kNoMessages = 16;
constexpr int kNoJournal = 16;
constexpr double kNoTapSeconds = 0.01;
/// The notes that live and those that begin in a part of a block, with room to spare.
constexpr std::size_t kMostEnded = 2 * engine::Engine::kMostNotesAtOnce;

}  // namespace

Instrument::Instrument(const InstrumentConfig& config)
    : config_(config), events_(kEventsAtOnce), ended_(kMostEnded) {
  if (auto spec = engine::read_bank(factory_presets()[0].path, factory_files())) {
    spec_ = *std::move(spec);
  }
}
Instrument::~Instrument() = default;

const PluginInfo& Instrument::info() const { return instrument_info(); }

Result<void> Instrument::load(engine::BankSpec spec) {
  for (const engine::PatchSpec& patch : spec.patches) {
    for (const engine::OscillatorSpec& oscillator : patch.oscillators) {
      if (oscillator.wave_file.empty()) continue;
      return fail(ErrorCode::unsupported, "patch '" + patch.name + "' plays the sound file " +
                                              oscillator.wave_file +
                                              ": a plugin plays curves, not sound files");
    }
  }
  auto program = engine::BankProgram::create(spec);
  if (!program) return program.error();
  spec_ = std::move(spec);
  program_ = *std::move(program);
  if (live_ == nullptr) return {};
  live_->collect();
  live_->install(std::move(program_));
  return {};
}

Result<void> Instrument::load_preset(std::size_t number) {
  if (number >= factory_presets().size()) {
    return fail(ErrorCode::value_out_of_range,
                "there is no preset " + std::to_string(number) + "; 0 to " +
                    std::to_string(factory_presets().size() - 1) + " are there");
  }
  auto spec = engine::read_bank(factory_presets()[number].path, factory_files());
  if (!spec) return spec.error();
  return load(*std::move(spec));
}

Result<void> Instrument::load_file(const std::string& path) {
  auto spec = engine::read_bank(path);
  if (!spec) return spec.error();
  return load(*std::move(spec));
}

Result<void> Instrument::activate(double rate_hz) {
  if (program_ == nullptr) {
    auto program = engine::BankProgram::create(spec_);
    if (!program) return program.error();
    program_ = *std::move(program);
  }
  engine::LiveConfig config;
  config.engine.rate_hz = rate_hz;
  config.engine.max_voices = config_.max_voices;
  config.input_messages = kNoMessages;
  config.journal_records = kNoJournal;
  config.tap_s = kNoTapSeconds;
  auto live = engine::LiveEngine::create(config, std::move(program_));
  if (!live) return live.error();
  live_ = *std::move(live);
  values_.forget_heard();
  modulation_.fill(0);
  tempo_microseconds_ = 500000;
  is_playing_ = is_song_due_ = false;
  event_count_ = 0;
  return {};
}

void Instrument::deactivate() { live_.reset(); }

void Instrument::collect() {
  if (live_ != nullptr) live_->collect();
}

void Instrument::set_parameter(std::size_t place, double value) KNOTWAVE_RT {
  values_.set(place, value);
}

double Instrument::parameter(std::size_t place) const KNOTWAVE_RT { return values_.get(place); }

void Instrument::begin(const Block& block) KNOTWAVE_RT {
  begin({block.out[0], block.frames}, {block.out[1], block.frames});
}

void Instrument::begin(std::span<float> left, std::span<float> right) KNOTWAVE_RT {
  left_ = left;
  right_ = right;
  done_ = 0;  // events that waited stay
  ended_count_ = 0;
  values_.take_news([this](std::size_t place, double) { push_parameter(place, 0); });
}

/// What the host automates and what it modulates, as one number of every voice.
void Instrument::push_parameter(std::size_t place, std::int64_t sample) KNOTWAVE_RT {
  Event event;
  event.kind = Event::Kind::set_target;
  event.midi.time.sample = sample;
  event.slot = static_cast<std::uint16_t>(table()[place].slot);
  event.number = values_.heard(place) + modulation_[place];
  event.every_channel = true;
  push(event);
}

/// The song's position goes before what comes later.
void Instrument::push(const Event& event) KNOTWAVE_RT {
  if (song_due_ <= event.time()) place_song();
  place(event);
}

void Instrument::place_song() KNOTWAVE_RT {
  if (!std::exchange(is_song_due_, false)) return;
  Event song;
  song.kind = Event::Kind::position;
  song.midi.time = song_due_;
  song.song_clocks = song_clocks_;
  place(song);
}

void Instrument::place(const Event& event) KNOTWAVE_RT {
  if (event_count_ == events_.size()) {
    const auto at = static_cast<std::size_t>(std::max<std::int64_t>(event.time().sample, 0));
    render_until(std::min(std::max(at, done_ + 1), left_.size()));
  }
  const bool waits = done_ == left_.size();  // for the next block, and its bytes would not
  if (event_count_ == events_.size() || (waits && event.midi.sysex != nullptr)) return;
  Event& added = events_[event_count_++];
  added = event;
  added.midi.time.sample =
      std::max<std::int64_t>(event.midi.time.sample - static_cast<std::int64_t>(done_), 0);
}

void Instrument::add(const Event& event) KNOTWAVE_RT { push(event); }

void Instrument::add_parameter(std::size_t place, double value, std::int64_t sample) KNOTWAVE_RT {
  if (place >= table().size()) return;
  values_.set_heard(place, value);
  push_parameter(place, sample);
}

void Instrument::add_modulation(std::size_t place, double amount, const NoteAddress& notes,
                                std::int64_t sample) KNOTWAVE_RT {
  if (place >= table().size() || amount != amount) return;
  if (notes.is_every()) {
    modulation_[place] = amount;
    return push_parameter(place, sample);
  }
  Event event;
  event.kind = Event::Kind::set_note;
  event.midi.time.sample = sample;
  event.midi.bytes[0] = static_cast<std::uint8_t>(std::max(notes.channel, 0) & 15);
  event.midi.bytes[1] =
      notes.key < 0 ? std::uint8_t{Event::kEveryKey} : static_cast<std::uint8_t>(notes.key & 127);
  event.every_channel = notes.channel < 0;
  event.note = notes.note;
  event.slot = static_cast<std::uint16_t>(table()[place].slot);
  event.number = amount;
  push(event);
}

void Instrument::add_transport(const Transport& transport, std::int64_t sample) KNOTWAVE_RT {
  const double bpm = transport.beats_per_minute;
  if (bpm >= kLeastBpm && bpm <= kMostBpm) {
    const auto microseconds = static_cast<std::uint32_t>(std::floor(6e7 / bpm + 0.5));
    if (microseconds != tempo_microseconds_) {
      tempo_microseconds_ = microseconds;
      Event event;
      event.kind = Event::Kind::tempo;
      event.midi.time.sample = sample;
      event.microseconds_per_quarter = microseconds;
      push(event);
    }
  }
  follow_song(transport, sample);
}

void Instrument::follow_song(const Transport& transport, std::int64_t sample) KNOTWAVE_RT {
  const double samples_a_quarter = tempo_microseconds_ * 1e-6 * live_->rate_hz();
  const double expected = quarters_ + static_cast<double>(sample) / samples_a_quarter;
  const bool was_playing = is_playing_;
  is_playing_ = transport.is_playing && transport.has_position && transport.quarters >= 0 &&
                transport.quarters <= kMostQuarters;
  if (!is_playing_) return;
  quarters_ = transport.quarters - static_cast<double>(sample) / samples_a_quarter;
  if (was_playing && std::abs(transport.quarters - expected) <= kJumpQuarters) return;
  const double clocks = std::ceil(transport.quarters * engine::kSongClocksPerQuarter - 1e-6);
  const double wait = std::max(
      (clocks / engine::kSongClocksPerQuarter - transport.quarters) * samples_a_quarter, 0.0);
  const double whole = std::floor(wait);
  song_due_ = {sample + static_cast<std::int64_t>(whole),
               static_cast<std::uint32_t>((wait - whole) * 0x1p32)};
  song_clocks_ = static_cast<std::int64_t>(clocks);
  is_song_due_ = true;
}

void Instrument::render_until(std::size_t sample) KNOTWAVE_RT {
  const std::size_t n = sample - done_;
  if (n == 0) return;
  live_->process(0, std::span(events_).first(event_count_), left_.subspan(done_, n),
                 right_.subspan(done_, n));
  for (const engine::EndedNote& note : live_->ended_notes()) {
    if (ended_count_ < ended_.size()) ended_[ended_count_++] = note;
  }
  event_count_ = 0;
  done_ = sample;
}

void Instrument::render() KNOTWAVE_RT {
  const auto frames = static_cast<std::int64_t>(left_.size());
  if (song_due_.sample < frames) place_song();
  render_until(left_.size());
  song_due_.sample -= frames;
  quarters_ += static_cast<double>(frames) / (tempo_microseconds_ * 1e-6 * live_->rate_hz());
}

/// Notes end within 5 ms, which nobody hears.
void Instrument::reset() KNOTWAVE_RT {
  event_count_ = 0;
  constexpr std::size_t kPart = 64;
  constexpr double kFadeSeconds = 0.0055;
  std::array<float, kPart> left, right;
  std::array<Event, 16> silence;
  for (std::size_t channel = 0; channel < silence.size(); ++channel) {
    silence[channel].midi.bytes[0] = static_cast<std::uint8_t>(0xB0 + channel);
    silence[channel].midi.bytes[1] = engine::kAllSoundOff;
  }
  std::span<const Event> events(silence);
  for (double left_s = kFadeSeconds; left_s > 0;
       left_s -= static_cast<double>(kPart) / live_->rate_hz()) {
    live_->process(0, events, left, right);
    events = {};
  }
}

bool Instrument::is_idle() const KNOTWAVE_RT { return live_->is_idle(); }

}  // namespace knotwave::plugins
