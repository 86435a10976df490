// SPDX-License-Identifier: MIT
// ns per sample and voice of the whole engine: oscillator, two envelopes, filter and four maps,
// next to the same voice written the naive way, one sample at a time with libm.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "knotwave/engine/engine.h"
#include "knotwave/engine/patch.h"

namespace {

using namespace knotwave;

constexpr std::size_t kBlock = 256;
constexpr double kRate = 48000;

/// What the naive voice does as well; `maps` are added behind.
constexpr const char* kVoice = R"(
format = 1
kind = "patch"
polyphony = 128
[curves.gate]
degree = 2
points = [0, 1, 1, 0.8, 0.8, 0.1, 0]
knots = [0,0,0, 0.01,0.01, 0.3,0.3, 0.42,0.42,0.42]
[oscillators.a]
wave = "saw"
[filter]
cutoff_hz = 800
resonance = 0.3
[envelopes.amp]
curve = "gate"
seconds = 0.42
sustain_at = 0.3
release_at = 0.3
[envelopes.sweep]
curve = "gate"
seconds = 40
[lfos.vibrato]
curve = "sine"
)";
constexpr const char* kMaps = R"(
[[maps]]
from = "sweep"
to = "filter.cutoff"
depth = 24
[[maps]]
from = "velocity"
to = "filter.cutoff"
depth = 12
[[maps]]
from = "vibrato"
to = "pitch"
depth = 0.2
[[maps]]
from = "mod"
to = "filter.resonance"
depth = 0.3
)";

std::unique_ptr<const engine::BankProgram> bank_of_text(const std::string& text) {
  auto patch = engine::parse_patch(text, "bench.toml");
  if (!patch) std::abort();
  auto bank = engine::BankProgram::create(engine::bank_of(*std::move(patch)));
  if (!bank) std::abort();
  return *std::move(bank);
}

void count_samples(benchmark::State& state, double voices) {
  const double samples = static_cast<double>(state.iterations()) * kBlock * voices;
  state.counters["ns/sample"] =
      benchmark::Counter(samples * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Args: voices, with maps, threads.
void engine_voices(benchmark::State& state) {
  const auto bank = bank_of_text(std::string(kVoice) + (state.range(1) != 0 ? kMaps : ""));
  const int voices = static_cast<int>(state.range(0));
  auto engine = engine::Engine::create(
      {.max_voices = 256, .threads = static_cast<int>(state.range(2))}, bank.get());
  std::vector<engine::Event> events(static_cast<std::size_t>(voices));
  for (int v = 0; v < voices; ++v) {
    auto& bytes = events[static_cast<std::size_t>(v)].midi.bytes;
    bytes[0] = static_cast<std::uint8_t>(0x90 | (v % 16));
    bytes[1] = static_cast<std::uint8_t>(36 + v % 48);
    bytes[2] = 100;
  }
  std::vector<float> left(kBlock), right(kBlock);
  (*engine)->process(events, left, right);
  for (auto _ : state) {
    (*engine)->process({}, left, right);
    benchmark::DoNotOptimize(left.data());
  }
  if ((*engine)->counters().voices_now != voices) state.SkipWithError("voices ended");
  count_samples(state, voices);
}
BENCHMARK(engine_voices)
    ->ArgNames({"voices", "maps", "threads"})
    ->Args({1, 0, 1})
    ->Args({1, 1, 1})
    ->Args({64, 0, 1})
    ->Args({64, 1, 1});
// Two threads are worth what the clock says.
BENCHMARK(engine_voices)
    ->Name("engine_voices_by_the_clock")
    ->ArgNames({"voices", "maps", "threads"})
    ->Args({64, 1, 1})
    ->Args({64, 1, 2})
    ->UseRealTime();

/// The same voice as most people would first write it; it aliases, steps and is not reproducible.
struct NaiveVoice {
  double phase = 0, lfo = 0, amp = 0, sweep = 0, low = 0, band = 0;
  std::vector<float> table;
  NaiveVoice() : table(2049) {
    for (std::size_t i = 0; i < table.size(); ++i) {
      table[i] = static_cast<float>(double(i) / 1024 - 1);
    }
  }
  float next(double note, double velocity, double wheel) {
    amp += (0.8 - amp) * 0.001;
    sweep += (1 - sweep) * 0.0001;
    lfo += 5 / kRate;
    lfo -= std::floor(lfo);
    const double pitch = note + 0.2 * std::sin(2 * std::numbers::pi * lfo);
    phase += 440 * std::exp2((pitch - 69) / 12) / kRate;
    phase -= std::floor(phase);
    const double place = phase * 2048;
    const auto index = static_cast<std::size_t>(place);
    const double fraction = place - static_cast<double>(index);
    const double saw = table[index] + fraction * (table[index + 1] - table[index]);
    const double cutoff = 800 * std::exp2((24 * sweep + 12 * velocity) / 12);
    const double g = std::tan(std::numbers::pi * std::min(cutoff / kRate, 0.49));
    const double k = 1 / (0.5 * std::pow(100, 0.3 + 0.3 * wheel));
    const double high = (saw - (k + g) * band - low) / (1 + g * (g + k));
    const double middle = g * high + band;
    const double bottom = g * middle + low;
    band = g * high + middle;
    low = g * middle + bottom;
    return static_cast<float>(bottom * amp * velocity);
  }
};

void naive_voice(benchmark::State& state) {
  NaiveVoice voice;
  std::vector<float> left(kBlock), right(kBlock);
  for (auto _ : state) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      const float y = voice.next(60, 100 / 127.0, 0);
      left[i] = y * 0.7F;
      right[i] = y * 0.7F;
    }
    benchmark::DoNotOptimize(left.data());
  }
  count_samples(state, 1);
}
BENCHMARK(naive_voice);

}  // namespace
