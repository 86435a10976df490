// SPDX-License-Identifier: MIT
// Curves on a grid beside the machine's own limit, a textbook de Boor, Eigen and Boost. AVX2 and no
// wider, one thread. "ns/sample" is what to compare; peers/compare_curves.py has the peers that run
// as programs of their own.
#include <cstdio>

#include <benchmark/benchmark.h>

#include "knotwave/curves/compile.h"
#include "knotwave/curves/fast_program.h"
#include "knotwave/curves/simd.h"

#include "peers/linked_peers.h"
#include "peers/peer_curve.h"

namespace knotwave::curves {
namespace {

constexpr std::size_t kNodes = peers::kGrid;
constexpr std::size_t kBlock = 64;
constexpr GridRun kRun{0, 1.0 / double(kNodes), 0};

void count_samples(benchmark::State& state, std::size_t samples) {
  state.SetLabel(simd_level_name());
  state.counters["ns/sample"] =
      benchmark::Counter(double(samples) * 1e-9, benchmark::Counter::kIsIterationInvariantRate |
                                                     benchmark::Counter::kInvert);
}

/// The common curve; degrees other than 3 have 13 spans and points of the same kind.
CurveSpec common_spec(int degree, bool rational, int dim = 1) {
  const peers::Curve common = peers::peer_curve();
  CurveSpec spec;
  spec.name = "common";
  spec.degree = degree;
  spec.dim = dim;
  for (int i = 0; i < 13 + degree; ++i) {
    for (int c = 0; c < dim; ++c) spec.points.push_back(common.points[std::size_t(i + 3 * c) % 16]);
    if (rational) spec.weights.push_back(common.weights[std::size_t(i) % 16]);
  }
  return spec;
}

CurveProgram program_of(int degree, bool rational, int dim = 1) {
  return *compile_parametric(*NurbsCurve::create(common_spec(degree, rational, dim)));
}

/// (0.42, 0) (0.58, 1): ease-in-out, its time inverted.
CurveProgram easing() {
  CurveSpec spec;
  spec.name = "easing";
  spec.dim = 2;
  spec.points = {0, 0, 0.42, 0, 0.58, 1, 1, 1};
  CompileOptions options;
  options.max_error = 0x1p-24;
  return *compile_function(*NurbsCurve::create(std::move(spec)), options);
}

/// The whole grid in one call, or in blocks into one buffer.
template <class Program, class Float>
void render_grid(benchmark::State& state, const Program& program, std::size_t block, Float) {
  std::vector<Float> out(block);
  CurveCursor cursor;
  for (auto _ : state) {
    for (std::size_t i = 0; i < kNodes; i += block) {
      program.render(GridRun{0, kRun.step, std::int64_t(i)}, std::span(out), cursor);
      benchmark::ClobberMemory();
    }
    benchmark::DoNotOptimize(out.data());
  }
  count_samples(state, kNodes);
}

void fast(benchmark::State& state, const CurveProgram& program, std::size_t block) {
  const FastProgram fast(program);
  render_grid(state, fast, block, 0.0F);
  state.counters["proved_error"] = fast.max_error();
}

void accurate(benchmark::State& state, const CurveProgram& program, std::size_t block) {
  render_grid(state, program, block, 0.0F);
  state.counters["error"] = program.max_error();
}

/// Four coordinates of one curve.
void four_of_one(benchmark::State& state, std::size_t block) {
  const FastProgram program(program_of(3, false, 4));
  std::vector<float> out(4 * block);
  const std::span<float> all(out);
  const std::span<float> outs[] = {all.first(block), all.subspan(block, block),
                                   all.subspan(2 * block, block), all.last(block)};
  CurveCursor cursor;
  for (auto _ : state) {
    for (std::size_t i = 0; i < kNodes; i += block) {
      program.render(GridRun{0, kRun.step, std::int64_t(i)}, outs, cursor);
      benchmark::ClobberMemory();
    }
  }
  count_samples(state, kNodes);
}

/// Four curves with knots of their own.
void four_apart(benchmark::State& state, std::size_t block) {
  std::vector<FastProgram> programs;
  for (int c = 0; c < 4; ++c) {
    CurveSpec spec = common_spec(3, false);
    for (int i = 0; i < 3 * c; ++i) spec.points.push_back(0.1 * i);
    programs.emplace_back(*compile_parametric(*NurbsCurve::create(std::move(spec))));
  }
  std::vector<float> out(block);
  CurveCursor cursors[4];
  for (auto _ : state) {
    for (std::size_t i = 0; i < kNodes; i += block) {
      for (std::size_t c = 0; c < 4; ++c) {
        programs[c].render(GridRun{0, kRun.step, std::int64_t(i)}, out, cursors[c]);
        benchmark::ClobberMemory();
      }
    }
  }
  count_samples(state, kNodes);
}

void compile(benchmark::State& state, int degree, bool rational, bool fast_too) {
  CurveSpec spec;
  spec.name = "64 points";
  spec.degree = degree;
  const peers::Curve common = peers::peer_curve();
  for (std::size_t i = 0; i < 64; ++i) {
    spec.points.push_back(common.points[i % 16] * (1 - 0.01 * double(i)));
    if (rational) spec.weights.push_back(common.weights[i % 16]);
  }
  const NurbsCurve curve = *NurbsCurve::create(std::move(spec));
  for (auto _ : state) {
    auto program = compile_parametric(curve);
    if (fast_too) benchmark::DoNotOptimize(FastProgram(std::move(*program)).max_error());
    benchmark::DoNotOptimize(program);
  }
}

void peer(benchmark::State& state, const peers::NamedPeer& named) {
  std::vector<float> floats(kNodes);
  std::vector<double> doubles(kNodes);
  for (auto _ : state) {
    named.is_float ? named.peer->evaluate(floats) : named.peer->evaluate(doubles);
    benchmark::ClobberMemory();
  }
  count_samples(state, kNodes);
  state.SetLabel("per call");
}

void register_ours() {
  using benchmark::RegisterBenchmark;
  struct Form {
    const char* name;
    int degree;
    bool rational;
  };
  for (const Form& form : {Form{"cubic", 3, false},
                           {"rational_cubic", 3, true},
                           {"degree_7", 7, false},
                           {"rational_degree_7", 7, true}}) {
    const CurveProgram program = program_of(form.degree, form.rational);
    const std::string name = form.name;
    for (const std::size_t block : {kNodes, std::size_t{1024}, kBlock}) {
      const std::string of = block == kNodes ? "grid/" : "block_" + std::to_string(block) + "/";
      RegisterBenchmark(("ours_fast_" + of + name).c_str(), fast, program, block);
      RegisterBenchmark(("ours_accurate_" + of + name).c_str(), accurate, program, block);
    }
  }
  RegisterBenchmark("ours_fast_easing/grid", fast, easing(), kNodes);
  RegisterBenchmark("ours_fast_easing/block_64", fast, easing(), kBlock);
  RegisterBenchmark("ours_accurate_easing/grid", accurate, easing(), kNodes);
  RegisterBenchmark("ours_fast_four_coordinates/block_64", four_of_one, kBlock);
  RegisterBenchmark("ours_fast_four_coordinates/grid", four_of_one, kNodes);
  RegisterBenchmark("ours_fast_four_curves/block_64", four_apart, kBlock);
  RegisterBenchmark("ours_fast_four_curves/block_256", four_apart, std::size_t{256});
  RegisterBenchmark("compile_64_points/cubic", compile, 3, false, false);
  RegisterBenchmark("compile_64_points/cubic_and_fast", compile, 3, false, true);
  RegisterBenchmark("compile_64_points/degree_7", compile, 7, false, false);
  RegisterBenchmark("compile_64_points/rational_cubic", compile, 3, true, false);
}

/// Rows without a loop of their own: what the machine needs at least.
void register_limits() {
  static const peers::MachineLimits limits = peers::machine_limits();
  const auto row = [](const char* name, double ns) {
    benchmark::RegisterBenchmark(name, [ns](benchmark::State& state) {
      for (auto _ : state) benchmark::DoNotOptimize(ns);
      state.counters["ns/sample"] = ns;
    })->Iterations(1);
  };
  row("limit/cubic", limits.cubic);
  row("limit/rational_cubic", limits.rational_cubic);
  row("limit/degree_7_double", limits.degree_7_double);
  row("limit/store", limits.store);
}

}  // namespace
}  // namespace knotwave::curves

int main(int argc, char** argv) {
  using namespace knotwave::curves;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  // The others are built for AVX2.
  if (const auto set = set_simd_level(SimdLevel::avx2); !set) {
    std::fprintf(stderr, "curve_peers_bench: %s\n", set.error().message.c_str());
    return 1;
  }
  register_limits();
  register_ours();
  static const std::vector<peers::NamedPeer> all = peers::linked_peers();
  for (const peers::NamedPeer& named : all) {
    benchmark::RegisterBenchmark(named.name.c_str(),
                                 [&named](benchmark::State& state) { peer(state, named); });
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
