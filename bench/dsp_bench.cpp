// SPDX-License-Identifier: MIT
// ns per sample of envelopes, LFOs, shapers, the filter, smoothing, crossfades and noise, each
// beside the plain scalar way to do about the same.
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "knotwave/dsp/crossfade.h"
#include "knotwave/dsp/envelope.h"
#include "knotwave/dsp/filter.h"
#include "knotwave/dsp/glide.h"
#include "knotwave/dsp/lfo.h"
#include "knotwave/dsp/noise.h"
#include "knotwave/dsp/shaper.h"
#include "knotwave/dsp/smoother.h"

namespace {

using namespace knotwave;

constexpr std::size_t kBlock = 256;
constexpr double kRate = 48000;
constexpr double kTau = 6.283185307179586;

// Runs `block(first)` over and over and reports ns per sample of its kBlock samples.
template <class Block>
void per_sample(benchmark::State& state, const std::vector<double>& out, Block&& block) {
  std::int64_t first = 0;
  for (auto _ : state) {
    block(first);
    first += static_cast<std::int64_t>(kBlock);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  state.counters["ns/sample"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * kBlock * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

curves::NurbsCurve curve_of(std::vector<double> points, int degree, bool weighted = false) {
  curves::CurveSpec spec;
  spec.degree = degree;
  if (weighted) {
    for (std::size_t i = 0; i < points.size(); ++i) spec.weights.push_back(i % 2 == 0 ? 1 : 3);
  }
  spec.points = std::move(points);
  return curves::NurbsCurve::create(std::move(spec)).value();
}

curves::NurbsCurve bell(bool weighted) {
  return curve_of({0, 0, 1, 0.8, 0.5, 0.5, 0}, 3, weighted);
}

enum class Play { attack, hold, loop, join };

void envelope(benchmark::State& state, bool weighted, Play play) {
  dsp::EnvelopeSpec spec;
  spec.seconds = 1;
  if (play == Play::hold) spec.sustain_u = 0.5;
  if (play == Play::loop) spec.loop_start_u = 0.1, spec.loop_end_u = 0.6;
  const auto program = dsp::EnvelopeProgram::create(bell(weighted), spec).value();
  std::vector<double> out(kBlock);
  dsp::Envelope voice;
  voice.gate_on(program, {0, 0}, kRate, 1);
  const std::int64_t skip = play == Play::hold ? 96000 : 0;
  per_sample(state, out, [&](std::int64_t first) {
    const bool moves = play == Play::attack || play == Play::join;
    const std::int64_t here = moves ? first % 11776 + 100 : first + skip;
    if (moves && here == 100) {
      if (play == Play::attack) voice.reset();
      voice.gate_on(program, {here, 0}, kRate, 1);
    }
    voice.render(program, here, {}, out);
  });
}
BENCHMARK_CAPTURE(envelope, cubic_moving, false, Play::attack);
BENCHMARK_CAPTURE(envelope, rational_moving, true, Play::attack);
BENCHMARK_CAPTURE(envelope, cubic_holding, false, Play::hold);
BENCHMARK_CAPTURE(envelope, cubic_looping, false, Play::loop);
BENCHMARK_CAPTURE(envelope, cubic_joining, false, Play::join);

void envelope_one_at_a_time(benchmark::State& state) {
  const auto program = curves::compile_function(bell(false)).value();
  std::vector<double> out(kBlock);
  per_sample(state, out, [&](std::int64_t first) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      out[i] =
          program.at_u(static_cast<double>(first % 11776 + static_cast<std::int64_t>(i)) / kRate);
    }
  });
}
BENCHMARK(envelope_one_at_a_time);

// Straight lines and one state variable, as in many a synthesiser.
void envelope_plain_adsr(benchmark::State& state) {
  std::vector<double> out(kBlock);
  double level = 0;
  int stage = 0;
  per_sample(state, out, [&](std::int64_t) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      if (stage == 0) {
        level += 1 / (0.25 * kRate);
        if (level >= 1) stage = 1;
      } else {
        level -= 0.5 / (0.25 * kRate);
        if (level <= 0) level = 0, stage = 0;
      }
      out[i] = level;
    }
  });
}
BENCHMARK(envelope_plain_adsr);

void lfo(benchmark::State& state, bool bent, bool random) {
  const auto cycle = curves::compile_function(curve_of({0, 0, 1, -1, 0, 0}, 3)).value();
  const dsp::LfoSpec spec{.rate_hz = 5.3, .random = random};
  const std::vector<double> factor(bent ? kBlock : 0, 1.1);
  std::vector<double> out(kBlock);
  dsp::Lfo voice;
  voice.start(spec, {0, 0}, kRate, {1, 2, base::kRandomLfo});
  per_sample(state, out,
             [&](std::int64_t first) { voice.render(spec, cycle, first, factor, {}, out); });
}
BENCHMARK_CAPTURE(lfo, steady, false, false);
BENCHMARK_CAPTURE(lfo, rate_modulated, true, false);
BENCHMARK_CAPTURE(lfo, random, false, true);

void lfo_libm_sine(benchmark::State& state) {
  std::vector<double> out(kBlock);
  double phase = 0;
  per_sample(state, out, [&](std::int64_t) {
    for (double& y : out) {
      y = std::sin(kTau * phase);
      phase += 5.3 / kRate;
      if (phase >= 1) phase -= 1;
    }
  });
}
BENCHMARK(lfo_libm_sine);

void glide(benchmark::State& state) {
  std::vector<double> out(kBlock);
  dsp::Glide voice;
  voice.start(nullptr, 1, {0, 0}, 1e6, kRate);
  per_sample(state, out, [&](std::int64_t first) { voice.render(nullptr, first, out); });
}
BENCHMARK(glide);

std::vector<float> tone(float amplitude) {
  std::vector<float> in(kBlock);
  for (std::size_t i = 0; i < kBlock; ++i) {
    in[i] = amplitude * static_cast<float>(std::sin(kTau * 3 * static_cast<double>(i) / kBlock));
  }
  return in;
}

void shaper(benchmark::State& state, int spans) {
  curves::CurveSpec spec;
  for (int i = 0; i < spans + 3; ++i) spec.points.push_back(i % 2 == 0 ? -1.0 : 1.0);
  const int inner = spans - 1;
  spec.knots.assign(4, -1);
  for (int i = 1; i <= inner; ++i) spec.knots.push_back(-1 + 2.0 * i / spans);
  spec.knots.insert(spec.knots.end(), 4, 1);
  const auto program = dsp::ShaperProgram::create(*curves::NurbsCurve::create(spec)).value();
  const std::vector<float> in = tone(0.9F), drive(kBlock, 1);
  std::vector<float> shaped(kBlock);
  std::vector<double> out;
  dsp::Shaper voice;
  per_sample(state, out, [&](std::int64_t) {
    voice.render(program, drive, 1, in, shaped);
    benchmark::DoNotOptimize(shaped.data());
  });
}
BENCHMARK_CAPTURE(shaper, one_span, 1);
BENCHMARK_CAPTURE(shaper, nine_spans, 9);

// The quotient of antiderivatives with its epsilon branch, log(cosh) from libm.
void shaper_libm_antiderivative(benchmark::State& state) {
  const std::vector<float> in = tone(0.9F);
  std::vector<double> out(kBlock);
  double last = 0, last_area = 0;
  per_sample(state, out, [&](std::int64_t) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      const double x = static_cast<double>(in[i]);
      const double area = std::log(std::cosh(x));
      out[i] =
          std::abs(x - last) > 1e-5 ? (area - last_area) / (x - last) : std::tanh(0.5 * (x + last));
      last = x;
      last_area = area;
    }
  });
}
BENCHMARK(shaper_libm_antiderivative);

void shaper_libm_tanh(benchmark::State& state) {
  const std::vector<float> in = tone(0.9F);
  std::vector<double> out(kBlock);
  per_sample(state, out, [&](std::int64_t) {
    for (std::size_t i = 0; i < kBlock; ++i) out[i] = std::tanh(static_cast<double>(in[i]));
  });
}
BENCHMARK(shaper_libm_tanh);

void filter(benchmark::State& state, bool moves) {
  std::vector<float> cutoff(kBlock, 1000), resonance(kBlock, 0.4F), result(kBlock);
  for (std::size_t i = 0; moves && i < kBlock; ++i) cutoff[i] += static_cast<float>(i);
  const std::vector<float> in = tone(0.9F);
  std::vector<double> out;
  dsp::StateVariableFilter voice;
  per_sample(state, out, [&](std::int64_t) {
    voice.render(dsp::FilterKind::low, kRate, cutoff, resonance, in, result);
    benchmark::DoNotOptimize(result.data());
  });
}
BENCHMARK_CAPTURE(filter, held, false);
BENCHMARK_CAPTURE(filter, moving_every_sample, true);

void filter_libm(benchmark::State& state) {
  std::vector<float> cutoff(kBlock, 1000);
  for (std::size_t i = 0; i < kBlock; ++i) cutoff[i] += static_cast<float>(i);
  const std::vector<float> in = tone(0.9F);
  std::vector<double> out(kBlock);
  double ic1 = 0, ic2 = 0, resonance = 0.4;
  benchmark::DoNotOptimize(resonance);
  per_sample(state, out, [&](std::int64_t) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      const double g = std::tan(3.141592653589793 * static_cast<double>(cutoff[i]) / kRate);
      const double k = 2 * std::pow(100, -resonance);
      const double a1 = 1 / (1 + g * (g + k)), a2 = g * a1;
      const double v3 = static_cast<double>(in[i]) - ic2;
      const double v1 = a1 * ic1 + a2 * v3, v2 = ic2 + a2 * ic1 + g * a2 * v3;
      ic1 = 2 * v1 - ic1;
      ic2 = 2 * v2 - ic2;
      out[i] = v2;
    }
  });
}
BENCHMARK(filter_libm);

void smoother(benchmark::State& state, int moves) {
  std::vector<double> out(kBlock);
  dsp::Smoother voice;
  voice.reset(0, 8000);
  per_sample(state, out, [&](std::int64_t first) {
    if (moves > 0 && first % 1024 == 0) {  // eight moves at once when each block has one
      voice.set_target(static_cast<double>(first % 7), first);
    }
    voice.render(moves > 0 ? first + 1 : first, out);
  });
}
BENCHMARK_CAPTURE(smoother, still, 0);
BENCHMARK_CAPTURE(smoother, eight_moves_at_once, 8);

void smoother_one_pole(benchmark::State& state) {
  std::vector<double> out(kBlock);
  double state_y = 0;
  per_sample(state, out, [&](std::int64_t first) {
    const double target = static_cast<double>(first % 7);
    double y = state_y;
    for (double& sample : out) sample = y += 0.001 * (target - y);
    state_y = y;
  });
}
BENCHMARK(smoother_one_pole);

std::vector<double> positions() {
  std::vector<double> position(kBlock);
  for (std::size_t i = 0; i < kBlock; ++i) position[i] = static_cast<double>(i) / kBlock;
  return position;
}

void crossfade_equal_power(benchmark::State& state) {
  const std::vector<double> position = positions();
  std::vector<float> a(kBlock), b(kBlock);
  std::vector<double> out;
  per_sample(state, out, [&](std::int64_t) {
    dsp::equal_power(position, a, b);
    benchmark::DoNotOptimize(a.data());
    benchmark::DoNotOptimize(b.data());
  });
}
BENCHMARK(crossfade_equal_power);

void crossfade_libm_sin_cos(benchmark::State& state) {
  const std::vector<double> position = positions();
  std::vector<float> a(kBlock), b(kBlock);
  std::vector<double> out;
  per_sample(state, out, [&](std::int64_t) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      a[i] = static_cast<float>(std::cos(kTau / 4 * position[i]));
      b[i] = static_cast<float>(std::sin(kTau / 4 * position[i]));
    }
    benchmark::DoNotOptimize(a.data());
    benchmark::DoNotOptimize(b.data());
  });
}
BENCHMARK(crossfade_libm_sin_cos);

void noise(benchmark::State& state) {
  std::vector<float> result(kBlock);
  std::vector<double> out;
  per_sample(state, out, [&](std::int64_t first) {
    dsp::render_noise({1, 2, base::kRandomNoise}, first, result);
    benchmark::DoNotOptimize(result.data());
  });
}
BENCHMARK(noise);

// One 32-bit multiply and add a sample: fast, and a function of nothing but what came before.
void noise_congruential(benchmark::State& state) {
  std::vector<double> out(kBlock);
  std::uint32_t word = 1;
  per_sample(state, out, [&](std::int64_t) {
    for (double& sample : out) {
      word = word * 1664525U + 1013904223U;
      sample = static_cast<double>(static_cast<std::int32_t>(word)) * 0x1p-31;
    }
  });
}
BENCHMARK(noise_congruential);

}  // namespace
