// SPDX-License-Identifier: MIT
// An envelope player that is handed events and keeps what came out.
#pragma once
#include <algorithm>
#include <bit>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/engine/envelope_player.h"

namespace knotwave::engine {

inline std::unique_ptr<const EnvelopePatchProgram> envelope_program(const std::string& text) {
  const auto spec = parse_envelope_patch("format = 1\nkind = 'envelope'\n" + text, "test.toml");
  EXPECT_TRUE(spec) << spec.error().to_string();
  if (!spec) return nullptr;
  auto program = EnvelopePatchProgram::create(*spec);
  EXPECT_TRUE(program) << program.error().to_string();
  return program ? std::move(*program) : nullptr;
}

class EnvelopeRig {
 public:
  explicit EnvelopeRig(const std::string& text, EnvelopePlayerConfig config = {})
      : program_(envelope_program(text)) {
    auto player = EnvelopePlayer::create(config, program_.get());
    EXPECT_TRUE(player) << player.error().to_string();
    player_ = std::move(*player);
    values_.resize(static_cast<std::size_t>(player_->voices()) * program_->outputs().size());
  }

  /// Times rise. `sample` may have a fraction.
  void midi(double sample, int status, int one = 0, int two = 0) {
    Event event;
    event.midi.time = time_of(sample);
    event.midi.bytes[0] = static_cast<std::uint8_t>(status);
    event.midi.bytes[1] = static_cast<std::uint8_t>(one);
    event.midi.bytes[2] = static_cast<std::uint8_t>(two);
    events_.push_back(event);
  }
  void tempo(double sample, std::uint32_t microseconds) {
    Event event;
    event.kind = Event::Kind::tempo;
    event.midi.time = time_of(sample);
    event.microseconds_per_quarter = microseconds;
    events_.push_back(event);
  }
  void add(const Event& event) { events_.push_back(event); }
  /// Up to sample `until`, in blocks of `block` samples, split at events.
  void play(std::int64_t until, std::size_t block = EnvelopePlayer::kMostSamples) {
    while (player_->now() < until) {
      while (next_ < events_.size() &&
             base::first_sample(events_[next_].time()) <= player_->now()) {
        player_->handle(events_[next_++]);
        keep_messages();
      }
      std::int64_t end = std::min(until, player_->now() + static_cast<std::int64_t>(block));
      if (next_ < events_.size()) {
        end = std::min(end, base::first_sample(events_[next_].time()));
      }
      player_->render(static_cast<std::size_t>(end - player_->now()));
      keep_messages();
      for (std::size_t row = 0; row < values_.size(); ++row) {
        const auto outputs = program_->outputs().size();
        const auto got =
            player_->values(static_cast<int>(row / outputs), static_cast<int>(row % outputs));
        values_[row].insert(values_[row].end(), got.begin(), got.end());
      }
    }
  }

  EnvelopePlayer& player() { return *player_; }
  const EnvelopePatchProgram& program() const { return *program_; }
  const std::vector<double>& values(int voice = 0, int output = 0) const {
    return values_[static_cast<std::size_t>(voice) * program_->outputs().size() +
                   static_cast<std::size_t>(output)];
  }
  double at(std::int64_t sample, int voice = 0, int output = 0) const {
    return values(voice, output).at(static_cast<std::size_t>(sample));
  }
  const std::vector<PlayerMessage>& messages() const { return messages_; }
  /// Messages as "sample status one two", fractions cut.
  std::vector<std::string> told() const {
    std::vector<std::string> all;
    for (const PlayerMessage& message : messages_) {
      const auto& bytes = message.midi.bytes;
      all.push_back(std::to_string(message.midi.time.sample) + " " + std::to_string(bytes[0]) +
                    " " + std::to_string(bytes[1]) + " " + std::to_string(bytes[2]));
    }
    return all;
  }
  /// Every bit of the values and messages.
  std::vector<std::uint64_t> bits() const {
    std::vector<std::uint64_t> all;
    for (const auto& row : values_) {
      for (const double value : row) all.push_back(std::bit_cast<std::uint64_t>(value));
    }
    for (const PlayerMessage& message : messages_) {
      all.push_back(static_cast<std::uint64_t>(message.midi.time.sample));
      all.push_back(message.midi.time.fraction);
      for (const std::uint8_t byte : message.midi.bytes) all.push_back(byte);
    }
    return all;
  }

  static base::SampleTime time_of(double sample) {
    const auto whole = static_cast<std::int64_t>(sample);
    return {whole, static_cast<std::uint32_t>((sample - static_cast<double>(whole)) * 0x1p32)};
  }

 private:
  void keep_messages() {
    const auto got = player_->take_messages();
    messages_.insert(messages_.end(), got.begin(), got.end());
  }

  std::unique_ptr<const EnvelopePatchProgram> program_;
  std::unique_ptr<EnvelopePlayer> player_;
  std::vector<Event> events_;
  std::size_t next_ = 0;
  std::vector<std::vector<double>> values_;
  std::vector<PlayerMessage> messages_;
};

/// Up to 1 in the first tenth, down to 0.5, held, and down to 0.
inline constexpr const char* kSwell =
    "[curves.swell]\ndegree = 1\npoints = [0, 1, 0.5, 0]\nknots = [0, 0, 0.1, 0.4, 1, 1]\n"
    "[envelopes.swell]\ncurve = 'swell'\nseconds = 1\nsustain_at = 0.4\n"
    "[[outputs]]\nfrom = 'swell'\nto = 'osc'\naddress = '/a'\n";

/// The same as a function of its place.
inline double swell(double u) {
  if (u < 0.1) return u / 0.1;
  if (u < 0.4) return 1 - 0.5 * (u - 0.1) / 0.3;
  return u < 1 ? 0.5 * (1 - u) / 0.6 : 0;
}

}  // namespace knotwave::engine
