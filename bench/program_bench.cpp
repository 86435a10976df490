// SPDX-License-Identifier: MIT
// Curve programs: blocks of 64 samples as the engine renders them, next to one sample at a time and
// to the baseline vector unit, and what compiling costs. Read "ns/sample" as nanoseconds; the label
// is the vector unit.
#include <cmath>

#include <benchmark/benchmark.h>

#include "knotwave/base/random.h"
#include "knotwave/curves/compile.h"
#include "knotwave/curves/moving_curve.h"
#include "knotwave/curves/simd.h"

namespace knotwave::curves {
namespace {

constexpr std::size_t kBlock = 64;
constexpr std::int64_t kPeriod = 16384;  // samples from u_min to u_max

NurbsCurve wavy(int degree, int points, bool rational) {
  CurveSpec spec;
  spec.name = "bench";
  spec.degree = degree;
  const base::RandomStream random{1, 0, 0};
  for (int i = 0; i < points; ++i) {
    spec.points.push_back(random.bipolar(std::uint64_t(i)));
    if (rational) spec.weights.push_back(0.3 + 3 * random.unit(std::uint64_t(1000 + i)));
  }
  return std::move(*NurbsCurve::create(std::move(spec)));
}

/// 16 spans of the degree asked.
CurveProgram program_of(int degree, bool rational) {
  return std::move(*compile_function(wavy(degree, degree + 16, rational)));
}

CurveProgram controlled(int controls) {
  CompileOptions options;
  for (int k = 0; k < controls; ++k) {
    options.controls.push_back({ControlRange::Kind::weight, 3 + 4 * k, 0, 0.1, 10});
  }
  return std::move(*compile_function(wavy(3, 19, false), options));
}

void count_samples(benchmark::State& state) {
  state.SetLabel(simd_level_name());
  state.counters["ns/sample"] = benchmark::Counter(
      static_cast<double>(kBlock) * 1e-9,
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <class Float>
void grid(benchmark::State& state, int degree, bool rational, SimdLevel level) {
  if (const auto set = set_simd_level(level); !set)
    state.SkipWithError(set.error().message.c_str());
  const CurveProgram program = program_of(degree, rational);
  CurveCursor cursor;
  Float out[kBlock];
  GridRun run{program.u_min(), (program.u_max() - program.u_min()) / double(kPeriod), 0};
  for (auto _ : state) {
    program.render(run, std::span<Float>(out), cursor);
    benchmark::DoNotOptimize(out);
    run.first = (run.first + std::int64_t(kBlock)) % kPeriod;
  }
  count_samples(state);
  (void)set_simd_level(SimdLevel::best);  // is always there
}

void grid_float(benchmark::State& state, int degree, bool rational, SimdLevel level) {
  grid<float>(state, degree, rational, level);
}
void grid_double(benchmark::State& state, int degree, bool rational, SimdLevel level) {
  grid<double>(state, degree, rational, level);
}

void one_at_a_time(benchmark::State& state, int degree, bool rational) {
  const CurveProgram program = program_of(degree, rational);
  float out[kBlock];
  GridRun run{program.u_min(), (program.u_max() - program.u_min()) / double(kPeriod), 0};
  for (auto _ : state) {
    for (std::size_t i = 0; i < kBlock; ++i) {
      out[i] = static_cast<float>(program.at_u(run.at(std::int64_t(i))));
    }
    benchmark::DoNotOptimize(out);
    run.first = (run.first + std::int64_t(kBlock)) % kPeriod;
  }
  count_samples(state);
}

void array(benchmark::State& state, int spans, double spread) {
  const CurveProgram program = std::move(*compile_function(wavy(3, 3 + spans, false)));
  const base::RandomStream random{2, 0, 0};
  std::vector<double> u(65536), out(kBlock);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double even = double(i) / double(u.size());
    u[i] = (1 - spread) * even + spread * random.unit(i);
  }
  CurveCursor cursor;
  std::size_t at = 0;
  for (auto _ : state) {
    program.render(std::span(u).subspan(at, kBlock), out, cursor);
    benchmark::DoNotOptimize(out.data());
    at = (at + kBlock) % u.size();
  }
  count_samples(state);
}

void with_controls(benchmark::State& state, int controls) {
  const CurveProgram program = controlled(controls);
  std::vector<double> u(kBlock), out(kBlock), moving(kBlock);
  std::vector<const double*> values(std::size_t(controls), moving.data());
  for (std::size_t i = 0; i < kBlock; ++i) moving[i] = 1 + 0.01 * double(i);
  CurveCursor cursor;
  GridRun run{0, 1.0 / double(kPeriod), 0};
  for (auto _ : state) {
    for (std::size_t i = 0; i < kBlock; ++i) u[i] = run.at(std::int64_t(i));
    program.render(u, values, out, cursor);
    benchmark::DoNotOptimize(out.data());
    run.first = (run.first + std::int64_t(kBlock)) % kPeriod;
  }
  count_samples(state);
}

/// A knot that moves: de Boor's algorithm at every sample.
void with_a_knot(benchmark::State& state, int degree, bool rational) {
  CompileOptions options;
  options.controls = {{ControlRange::Kind::knot, degree + 8, 0, 7.2 / 16, 8.8 / 16}};
  const CurveProgram program =
      std::move(*compile_function(wavy(degree, degree + 16, rational), options));
  std::vector<double> u(kBlock), out(kBlock), moving(kBlock);
  const double* const values[] = {moving.data()};
  for (std::size_t i = 0; i < kBlock; ++i) moving[i] = 0.5 + 0.0005 * double(i);
  CurveCursor cursor;
  GridRun run{0, 1.0 / double(kPeriod), 0};
  for (auto _ : state) {
    for (std::size_t i = 0; i < kBlock; ++i) u[i] = run.at(std::int64_t(i));
    program.render(u, values, out, cursor);
    benchmark::DoNotOptimize(out.data());
    run.first = (run.first + std::int64_t(kBlock)) % kPeriod;
  }
  count_samples(state);
}

void compile_easing(benchmark::State& state, double x1, double y1, double x2, double y2) {
  CurveSpec spec;
  spec.name = "easing";
  spec.dim = 2;
  spec.points = {0, 0, x1, y1, x2, y2, 1, 1};
  const NurbsCurve curve = std::move(*NurbsCurve::create(std::move(spec)));
  int pieces = 0;
  for (auto _ : state) {
    const auto program = compile_function(curve);
    pieces = program->piece_count();
    benchmark::DoNotOptimize(pieces);
  }
  state.counters["pieces"] = pieces;
}

/// Time inversion with all points moving: one span from (0, 0) to (1, 1).
void moving_points(benchmark::State& state, int degree) {
  CurveSpec spec;
  spec.name = "easing";
  spec.degree = degree;
  spec.dim = 2;
  for (int i = 0; i <= degree; ++i) {
    spec.points.insert(spec.points.end(), 2, double(i) / degree);
  }
  const MovingCurve moving = *MovingCurve::create(*NurbsCurve::create(spec));
  std::vector<double> times(kBlock), out(kBlock);
  std::vector<std::vector<double>> rows(spec.points.size(), std::vector<double>(kBlock));
  std::vector<const double*> points;
  for (std::size_t i = 0; i < kBlock; ++i) times[i] = (double(i) + 0.5) / kBlock;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (std::size_t i = 0; i < kBlock; ++i) rows[k][i] = spec.points[k] + 0.001 * double(i % 7);
    points.push_back(rows[k].data());
  }
  for (auto _ : state) {
    moving.render(times, points, out);
    benchmark::DoNotOptimize(out.data());
  }
  count_samples(state);
}

void compile_exact(benchmark::State& state, int points) {
  const NurbsCurve curve = wavy(3, points, true);
  for (auto _ : state) benchmark::DoNotOptimize(compile_function(curve)->piece_count());
}

constexpr auto kBest = SimdLevel::best;
constexpr auto kBaseline = SimdLevel::baseline;
BENCHMARK_CAPTURE(grid_float, cubic, 3, false, kBest);
BENCHMARK_CAPTURE(grid_float, cubic_baseline, 3, false, kBaseline);
BENCHMARK_CAPTURE(one_at_a_time, cubic, 3, false);
BENCHMARK_CAPTURE(grid_double, cubic, 3, false, kBest);
BENCHMARK_CAPTURE(grid_float, rational_cubic, 3, true, kBest);
BENCHMARK_CAPTURE(grid_float, rational_cubic_baseline, 3, true, kBaseline);
BENCHMARK_CAPTURE(one_at_a_time, rational_cubic, 3, true);
BENCHMARK_CAPTURE(grid_float, degree_7, 7, false, kBest);
BENCHMARK_CAPTURE(grid_float, degree_7_baseline, 7, false, kBaseline);
BENCHMARK_CAPTURE(one_at_a_time, degree_7, 7, false);
BENCHMARK_CAPTURE(grid_float, rational_degree_7, 7, true, kBest);
BENCHMARK_CAPTURE(array, in_order_64_spans, 64, 0.0);
BENCHMARK_CAPTURE(array, in_order_with_jitter_64_spans, 64, 0.001);
BENCHMARK_CAPTURE(array, random_u_64_spans, 64, 1.0);
BENCHMARK_CAPTURE(with_controls, one_weight, 1);
BENCHMARK_CAPTURE(with_controls, four_weights, 4);
BENCHMARK_CAPTURE(with_a_knot, cubic, 3, false);
BENCHMARK_CAPTURE(with_a_knot, rational_cubic, 3, true);
BENCHMARK_CAPTURE(with_a_knot, degree_7, 7, false);
BENCHMARK_CAPTURE(moving_points, cubic, 3);
BENCHMARK_CAPTURE(moving_points, degree_7, 7);
BENCHMARK_CAPTURE(compile_exact, cubic_64_points, 64);
BENCHMARK_CAPTURE(compile_easing, ease, .25, .1, .25, 1);
BENCHMARK_CAPTURE(compile_easing, vertical_start, 0, 1, 0, 1);
BENCHMARK_CAPTURE(compile_easing, vertical_inside, 1, 0, 0, 1);

}  // namespace
}  // namespace knotwave::curves
