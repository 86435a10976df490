// SPDX-License-Identifier: MIT
// Events, renders and measures that the tests of the engine share.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/engine/bank.h"
#include "knotwave/engine/engine.h"
#include "knotwave/engine/patch_program.h"

#include "scene_patches.h"

namespace knotwave::engine::scenes {

/// `lines` are put before the tables of `patch`: mode, polyphony, glide.
inline std::string with(std::string_view patch, std::string_view lines) {
  std::string text(patch);
  text.insert(text.find("name ="), std::string(lines) + "\n");
  return text;
}

/// Frequency of a sine from its upward zero crossings, interpolated; 0 when there are none.
inline double frequency_hz(const std::vector<float>& x, std::size_t from, std::size_t to,
                           double rate_hz = 48000) {
  double first = -1, last = -1;
  int count = 0;
  for (std::size_t i = from; i + 1 < to; ++i) {
    if (!(x[i] < 0 && x[i + 1] >= 0)) continue;
    const double a = static_cast<double>(x[i]), b = static_cast<double>(x[i + 1]);
    last = static_cast<double>(i) - a / (b - a);
    if (first < 0) first = last;
    ++count;
  }
  return count < 2 ? 0 : (count - 1) * rate_hz / (last - first);
}

inline double dbfs(double x) { return 20 * std::log10(std::max(x, 1e-30)); }

inline std::unique_ptr<const BankProgram> bank_from(std::string_view patch_text) {
  auto patch = parse_patch(patch_text, "scene.toml");
  EXPECT_TRUE(patch) << (patch ? "" : patch.error().to_string());
  if (!patch) return nullptr;
  auto bank = BankProgram::create(bank_of(*std::move(patch)));
  EXPECT_TRUE(bank) << (bank ? "" : bank.error().to_string());
  return bank ? *std::move(bank) : nullptr;
}

inline std::unique_ptr<const PatchProgram> program_from(std::string_view patch_text) {
  auto patch = parse_patch(patch_text, "scene.toml");
  EXPECT_TRUE(patch) << (patch ? "" : patch.error().to_string());
  if (!patch) return nullptr;
  auto program = PatchProgram::create(*patch);
  EXPECT_TRUE(program) << (program ? "" : program.error().to_string());
  return program ? *std::move(program) : nullptr;
}

inline std::unique_ptr<Engine> engine_for(const BankProgram& bank, EngineConfig config = {}) {
  auto made = Engine::create(config, &bank);
  EXPECT_TRUE(made) << (made ? "" : made.error().to_string());
  return *std::move(made);
}

inline Event midi(std::int64_t sample, int status, int one, int two, std::uint32_t fraction = 0) {
  Event event;
  event.midi.time = {sample, fraction};
  event.midi.bytes[0] = static_cast<std::uint8_t>(status);
  event.midi.bytes[1] = static_cast<std::uint8_t>(one);
  event.midi.bytes[2] = static_cast<std::uint8_t>(two);
  return event;
}
inline Event on(std::int64_t sample, int channel, int key, int velocity = 100) {
  return midi(sample, 0x90 | channel, key, velocity);
}
inline Event off(std::int64_t sample, int channel, int key, int velocity = 64) {
  return midi(sample, 0x80 | channel, key, velocity);
}
inline Event control(std::int64_t sample, int channel, int controller, int value) {
  return midi(sample, 0xB0 | channel, controller, value);
}
inline Event of_kind(std::int64_t sample, Event::Kind kind) {
  Event event;
  event.midi.time = {sample, 0};
  event.kind = kind;
  return event;
}

struct Sound {
  std::vector<float> left, right;
  bool operator==(const Sound&) const = default;
};

/// The next `frames` samples in blocks of `block`; `events` are sorted and at absolute samples.
inline Sound play(Engine& engine, const std::vector<Event>& events, std::size_t frames,
                  std::size_t block = 256) {
  Sound sound{std::vector<float>(frames), std::vector<float>(frames)};
  std::size_t next = 0;
  for (std::size_t at = 0; at < frames; at += block) {
    const std::size_t n = std::min(block, frames - at);
    const std::int64_t end = engine.now() + static_cast<std::int64_t>(n);
    const std::size_t first = next;
    while (next < events.size() && events[next].time().sample < end) ++next;
    engine.process(std::span(events).subspan(first, next - first),
                   std::span(sound.left).subspan(at, n), std::span(sound.right).subspan(at, n));
  }
  return sound;
}

inline double peak(const std::vector<float>& samples, std::size_t from = 0,
                   std::size_t to = SIZE_MAX) {
  double most = 0;
  for (std::size_t i = from; i < std::min(to, samples.size()); ++i) {
    most = std::max(most, std::abs(static_cast<double>(samples[i])));
  }
  return most;
}

}  // namespace knotwave::engine::scenes
