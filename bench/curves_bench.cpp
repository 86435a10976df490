// SPDX-License-Identifier: MIT
// What a value of a curve costs: exact, in the compiled program, and the two scalar ways others
// take (an allocated de Boor triangle a call; de Boor on the stack a call). ns/sample is what to
// compare.
#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "knotwave/curves/algorithms.h"
#include "knotwave/curves/compile.h"

namespace {

using namespace knotwave::curves;

constexpr int kSamples = 65536;
constexpr int kSpans = 16;

NurbsCurve curve_of(int degree, bool rational) {
  CurveSpec spec;
  spec.degree = degree;
  for (int i = 0; i < kSpans + degree; ++i) {
    spec.points.push_back(0.1 * (i * 7 % 11) - 0.5);
    if (rational) spec.weights.push_back(1 + i % 3);
  }
  return *NurbsCurve::create(spec);
}

void report(benchmark::State& state) {
  using benchmark::Counter;
  state.counters["ns/sample"] =
      Counter(1e-9 * static_cast<double>(kSamples) * static_cast<double>(state.iterations()),
              Counter::kIsRate | Counter::kInvert);
}

/// One dimension, no weights; `triangle` has (p + 1)^2 numbers.
double de_boor_double(const NurbsCurve& curve, double u, double* triangle) {
  const int p = curve.degree();
  const auto knots = curve.knots();
  const auto end = knots.begin() + curve.point_count();
  const int span =
      static_cast<int>(std::upper_bound(knots.begin() + p, end, u) - knots.begin()) - 1;
  for (int r = 0; r <= p; ++r) triangle[r] = curve.points()[std::size_t(span - p + r)];
  for (int level = 1; level <= p; ++level) {
    for (int r = 0; r <= p - level; ++r) {
      const double left = knots[std::size_t(span - p + level + r)];
      const double right = knots[std::size_t(span + 1 + r)];
      const double a = (u - left) / (right - left);
      triangle[level * (p + 1) + r] = (1 - a) * triangle[(level - 1) * (p + 1) + r] +
                                      a * triangle[(level - 1) * (p + 1) + r + 1];
    }
  }
  return triangle[p * (p + 1)];
}

void baseline_malloc_de_boor(benchmark::State& state) {
  const NurbsCurve curve = curve_of(static_cast<int>(state.range(0)), false);
  const std::size_t order = std::size_t(curve.degree()) + 1;
  for (auto _ : state) {
    double sum = 0;
    for (int i = 0; i < kSamples; ++i) {
      auto* triangle = static_cast<double*>(std::malloc(order * order * sizeof(double)));
      benchmark::DoNotOptimize(triangle);
      sum += de_boor_double(curve, i / double(kSamples), triangle);
      std::free(triangle);
    }
    benchmark::DoNotOptimize(sum);
  }
  report(state);
}
BENCHMARK(baseline_malloc_de_boor)->Arg(3)->Arg(7);

void baseline_de_boor(benchmark::State& state) {
  const NurbsCurve curve = curve_of(static_cast<int>(state.range(0)), false);
  double triangle[(kMaxDegree + 1) * (kMaxDegree + 1)];
  for (auto _ : state) {
    double sum = 0;
    for (int i = 0; i < kSamples; ++i) sum += de_boor_double(curve, i / double(kSamples), triangle);
    benchmark::DoNotOptimize(sum);
  }
  report(state);
}
BENCHMARK(baseline_de_boor)->Arg(3)->Arg(7);

void exact_evaluate(benchmark::State& state) {
  const NurbsCurve curve = curve_of(static_cast<int>(state.range(0)), state.range(1) != 0);
  for (auto _ : state) {
    double sum = 0, value = 0;
    for (int i = 0; i < kSamples; ++i) {
      curve.evaluate(i / double(kSamples), std::span(&value, 1));
      sum += value;
    }
    benchmark::DoNotOptimize(sum);
  }
  report(state);
}
BENCHMARK(exact_evaluate)->ArgNames({"degree", "rational"})->ArgsProduct({{1, 3, 7, 15}, {0, 1}});

template <class Float>
void grid_render(benchmark::State& state) {
  const auto program =
      compile_parametric(curve_of(static_cast<int>(state.range(0)), state.range(1) != 0));
  if (!program) return state.SkipWithError(program.error().message.c_str());
  const auto block = static_cast<std::size_t>(state.range(2));
  std::vector<Float> out(block);
  CurveCursor cursor;
  for (auto _ : state) {
    for (std::size_t first = 0; first < kSamples; first += block) {
      program->render(GridRun{0, 1.0 / kSamples, static_cast<std::int64_t>(first)}, out, cursor);
      benchmark::DoNotOptimize(out.data());
      benchmark::ClobberMemory();
    }
  }
  report(state);
}
// One row to compare with; program_bench measures programs.
BENCHMARK(grid_render<float>)
    ->ArgNames({"degree", "rational", "block"})
    ->ArgsProduct({{3, 7}, {0, 1}, {64}});

}  // namespace
