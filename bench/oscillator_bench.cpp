// SPDX-License-Identifier: MIT
// ns per sample of the table oscillator beside its one-sample reference, and the cost of making
// tables.
#include <vector>

#include <benchmark/benchmark.h>

#include "knotwave/curves/nurbs_curve.h"
#include "knotwave/dsp/builtin_waves.h"
#include "knotwave/dsp/oscillator.h"

namespace {

using namespace knotwave;

constexpr std::size_t kBlock = 256;
constexpr double kRate = 48000;

dsp::WaveTables saw() { return *dsp::builtin_wave("saw"); }

dsp::WaveTables surface(int dim, int degree_v) {
  curves::SurfaceSpec spec;
  spec.count_u = 16;
  spec.count_v = 8;
  spec.degree_v = degree_v;
  spec.dim = dim;
  spec.periodic_u = true;
  for (int k = 0; k < 16 * 8 * dim; ++k) spec.points.push_back(((k * 37) % 19 - 9) / 9.0);
  return *dsp::WaveTables::create(*curves::NurbsSurface::create(spec));
}

void per_sample(benchmark::State& state) {
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * kBlock));
  state.counters["ns/sample"] =
      benchmark::Counter(static_cast<double>(state.iterations() * kBlock) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

enum class Motion { still, vibrato, position, phase };

void render(benchmark::State& state, const dsp::WaveTables& tables, double hz, Motion motion) {
  std::vector<base::Phase> increments(kBlock, base::phase_increment(hz, kRate));
  std::vector<float> positions(kBlock, 0.3F), offsets(kBlock), left(kBlock), right(kBlock);
  for (std::size_t i = 0; i < kBlock; ++i) {
    if (motion == Motion::vibrato) increments[i].value += i << 40;
    if (motion == Motion::position) positions[i] = static_cast<float>(i) / kBlock;
    offsets[i] = static_cast<float>(i) * 0.001F;
  }
  dsp::TableOscillator oscillator;
  const bool stereo = tables.channels() == 2;
  for (auto _ : state) {
    oscillator.render(
        tables, increments, positions,
        motion == Motion::phase ? std::span<const float>(offsets) : std::span<const float>(), left,
        stereo ? std::span<float>(right) : std::span<float>());
    benchmark::DoNotOptimize(left.data());
    benchmark::ClobberMemory();
  }
  per_sample(state);
}

void BM_OscillatorMono(benchmark::State& state) {
  render(state, saw(), static_cast<double>(state.range(0)), Motion::still);
}
BENCHMARK(BM_OscillatorMono)->Arg(55)->Arg(440)->Arg(4186);

void BM_OscillatorMonoVibrato(benchmark::State& state) {
  render(state, saw(), 440, Motion::vibrato);
}
BENCHMARK(BM_OscillatorMonoVibrato);

void BM_OscillatorMonoPhaseModulated(benchmark::State& state) {
  render(state, saw(), 440, Motion::phase);
}
BENCHMARK(BM_OscillatorMonoPhaseModulated);

void BM_OscillatorSurfaceStill(benchmark::State& state) {
  render(state, surface(1, 3), 440, Motion::still);
}
BENCHMARK(BM_OscillatorSurfaceStill);

void BM_OscillatorSurfaceMoving(benchmark::State& state) {
  render(state, surface(1, 3), 440, Motion::position);
}
BENCHMARK(BM_OscillatorSurfaceMoving);

void BM_OscillatorStereoSurfaceStill(benchmark::State& state) {
  render(state, surface(2, 3), 440, Motion::still);
}
BENCHMARK(BM_OscillatorStereoSurfaceStill);

void BM_ReadOneSampleAtATime(benchmark::State& state) {
  const dsp::WaveTables tables = saw();
  const base::Phase increment = base::phase_increment(440, kRate);
  const int level = tables.level_for(increment);
  std::vector<float> out(kBlock);
  base::Phase phase;
  for (auto _ : state) {
    for (float& sample : out) {
      sample = tables.read(level, {}, 0, phase);
      phase = phase + increment;
    }
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  per_sample(state);
}
BENCHMARK(BM_ReadOneSampleAtATime);

void BM_MakeSawTables(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(saw().memory_bytes());
}
BENCHMARK(BM_MakeSawTables)->Unit(benchmark::kMillisecond);

void BM_MakeTablesOf256CyclesOf2048(benchmark::State& state) {
  std::vector<float> samples(std::size_t(2048) * 256);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k] = static_cast<float>((k * 7919) % 2003) / 1000.0F - 1;
  }
  for (auto _ : state) {
    const auto tables = dsp::WaveTables::create_from_cycles(samples, 2048, 256);
    if (!tables) state.SkipWithError(tables.error().message.c_str());
    state.counters["MiB"] = static_cast<double>(tables->memory_bytes()) / (1 << 20);
  }
}
BENCHMARK(BM_MakeTablesOf256CyclesOf2048)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
