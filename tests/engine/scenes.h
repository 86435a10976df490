// SPDX-License-Identifier: MIT
// Patches, events and renders that the tests of the engine share.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/engine/engine.h"
#include "knotwave/engine/patch.h"

namespace knotwave::engine::scenes {

/// One oscillator and a loudness that rises in 10 ms, holds, and falls in 50 ms to exactly 0.
inline constexpr std::string_view kPlain = R"(
format = 1
kind = "patch"
name = "Plain"
[curves.gate]
degree = 2
points = [0, 1, 1, 1, 0, 0]
knots = [0,0,0, 0.01,0.01, 0.035, 0.06,0.06,0.06]
[oscillators.a]
wave = "sine"
[envelopes.amp]
curve = "gate"
seconds = 0.06
sustain_at = 0.01
release_at = 0.01
)";

/// Everything at once: two stereo sources, crossfade, shaper, filter, five envelopes and LFOs, maps
/// of every kind.
inline constexpr std::string_view kRich = R"(
format = 1
kind = "patch"
name = "Rich"
polyphony = 6
glide_s = 0.05
[curves.gate]
degree = 2
points = [0, 1, 1, 1, 0, 0]
knots = [0,0,0, 0.01,0.01, 0.035, 0.06,0.06,0.06]
[curves.fall]
degree = 3
points = [1, 0.18, 0.04, 0.001]
weights = [1, 1.5, 2, 1]
[curves.drawn]
degree = 3
periodic = true
points = [-0.9, -0.2, 0.9, 1, 0.2, 0.7, 0.1, -0.3, 0.35, -0.5, -1]
[curves.bend]
degree = 2
points = [0, 0.2, 1]
[curves.fold]
degree = 3
points = [-1, -1.2, 1.2, 1]
knots = [-1,-1,-1,-1, 1,1,1,1]
[surfaces.morph]
degree_u = 3
degree_v = 1
periodic_u = true
points = [[0, 1, 0, -1, 0.2], [0.5, -1, 0.3, 1, -0.8]]
[surfaces.by_wheel]
degree_u = 1
degree_v = 1
knots_u = [-1,-1,1,1]
points = [[0, 0], [-1, 1]]
[oscillators.a]
wave = "morph"
pan = 0.3
[oscillators.b]
wave = "drawn"
detune_cents = 9
pan = 0.8
phase = "random"
[noise]
level_db = -30
envelope = "sweep"
[crossfade]
between = ["a", "b"]
position = 0.4
[shaper]
curve = "fold"
mix = 0.5
[filter]
kind = "low"
cutoff_hz = 1200
resonance = 0.3
key_track = 0.5
[envelopes.amp]
curve = "gate"
seconds = 0.06
sustain_at = 0.01
release_at = 0.01
[envelopes.sweep]
curve = "fall"
seconds = 0.4
velocity_time = 1
key_time = 0.5
[lfos.vibrato]
curve = "sine"
rate_hz = 5.4
[lfos.steps]
curve = "triangle"
beats = 0.5
mode = "free"
[[maps]]
from = ["vibrato", "mod"]
surface = "by_wheel"
to = "pitch"
depth = 0.4
[[maps]]
from = "sweep"
to = "filter.cutoff"
depth = 30
[[maps]]
from = "pressure"
curve = "bend"
to = "a.position"
[[maps]]
from = "timbre"
to = "crossfade"
depth = 0.5
[[maps]]
from = "steps"
to = "pan"
depth = 0.2
[[maps]]
from = "velocity"
to = "shaper.drive"
depth = 6
[[maps]]
from = "mod"
to = "curve.fall.weight.1"
low = 0.5
high = 3
[[maps]]
from = "vibrato"
to = "b.pitch"
depth = 0.1
)";

/// A loudness that ends at a thousandth and a sound that ends before its key is up.
inline constexpr std::string_view kEndsAboveZero = R"(
format = 1
kind = "patch"
name = "Struck"
velocity_db = 18
[curves.ring]
degree = 4
points = [1, 0.15962, 0.030761, 0.0058833, 0.001]
weights = [0.033544, 0.068924, 0.15018, 0.35327, 1]
[oscillators.a]
wave = "triangle"
[envelopes.amp]
curve = "ring"
seconds = 0.05
velocity_time = 0.3
)";

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
