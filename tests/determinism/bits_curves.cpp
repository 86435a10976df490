// SPDX-License-Identifier: MIT
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "knotwave/curves/compile.h"
#include "knotwave/curves/fast_program.h"
#include "knotwave/curves/moving_curve.h"
#include "knotwave/curves/nurbs_curve.h"

#include "bits.h"

namespace knotwave::bits {
namespace {

constexpr int kCount = 4001;

curves::NurbsCurve make(const curves::CurveSpec& spec) {
  Result<curves::NurbsCurve> curve = curves::NurbsCurve::create(spec);
  if (!curve) {
    std::fprintf(stderr, "%s\n", curve.error().to_string().c_str());
    std::exit(1);
  }
  return *curve;
}

void print_curve(const char* name, const curves::CurveSpec& spec) {
  const curves::NurbsCurve curve = make(spec);
  std::vector<double> values;
  for (int i = 0; i < kCount; ++i) {
    double value[3 * curves::kMaxDim] = {};
    const double u = spread(curve.u_min(), curve.u_max(), i, kCount);
    curve.derivatives(u, 2, curves::Side::right, {value, static_cast<std::size_t>(3 * spec.dim)});
    values.insert(values.end(), value, value + 3 * spec.dim);
  }
  print(name, values);
}

/// A handle curve (x = time) as a function: inversion, fit and grid.
void print_function(const char* name, const curves::CurveSpec& spec) {
  const auto program = curves::compile_function(make(spec));
  if (!program) {
    std::fprintf(stderr, "%s\n", program.error().to_string().c_str());
    std::exit(1);
  }
  std::vector<float> values(kCount);
  program->evaluate_grid({program->u_min(), program->u_max(), kCount - 1}, 0, values);
  print(name, values);
  std::vector<float> in_float(kCount);
  curves::FastProgram(*program).evaluate_grid({program->u_min(), program->u_max(), kCount - 1}, 0,
                                              in_float);
  print(name + std::string("_float"), in_float);
}

void print_functions() {
  print_function("function_ease", {.degree = 3, .dim = 2, .points = {0, 0, 1, 0, 0, 1, 1, 1}});
  print_function("function_rational", {.degree = 2,
                                       .dim = 2,
                                       .points = {0, 0, 0.2, 1.5, 0.7, -1, 1, 1},
                                       .weights = {1, 3, 0.3, 1}});
  print_function("degree_15",
                 {.degree = 15, .points = {0, 1, -1, 2, 0, 3, 1, -2, 0.5, 0.1, 1, 2, -1, 4, 0, 1}});
}

/// Time inversion while the handles move, all of them as far as they may.
void print_moving() {
  const auto moving = curves::MovingCurve::create(
      make({.degree = 3, .dim = 2, .points = {0, 0, 0, 0, 1, 1, 1, 1}}));
  std::vector<double> values;
  for (int i = 0; i < kCount; ++i) {
    const double a = spread(0, 1, i * 7 % kCount, kCount), b = spread(1, 0, i, kCount);
    const double points[] = {0, 0, a, 1 - b, b, a, 1, 1};
    values.push_back(moving->at(spread(0, 1, i * 31 % kCount, kCount), points));
  }
  print("moving_ease", values);
}

}  // namespace

void curves() {
  print_functions();
  print_moving();
  print_curve("curve_decay60", {.degree = 4,
                                .points = {1, 0.15962, 0.030761, 0.0058833, 0.001},
                                .weights = {0.033544, 0.068924, 0.15018, 0.35327, 1}});
  print_curve("curve_periodic_cubic",
              {.degree = 3, .points = {0, 0.7, 1, -0.3, -1, 0.4, -0.2, 0.1}, .periodic = true});
  print_curve("curve_plane_degree_7",
              {.degree = 7,
               .dim = 2,
               .points = {0, 0, 1, 3, 2, -1, 3, 0.5, 4, 2, 5, -2, 6, 1, 7, 0, 8, 3, 9, 1},
               .weights = {1, 2, 0.5, 3, 1, 0.1, 7, 1, 1.5, 1}});
}

}  // namespace knotwave::bits
