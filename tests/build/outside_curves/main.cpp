// SPDX-License-Identifier: MIT
// A curve from text, edited, compiled and rendered.
#include <cstdio>

#include "knotwave/curves/combine.h"
#include "knotwave/curves/compile.h"
#include "knotwave/curves/curve_file.h"

int main() {
  using namespace knotwave;
  const auto set = curves::parse_curves(
      "format = 1\nkind = \"curve\"\n[curves.ramp]\ndegree = 1\npoints = [0, 1]\n", "text");
  if (!set) {
    std::fprintf(stderr, "%s\n", set.error().to_string().c_str());
    return 1;
  }
  const auto square = curves::product(set->curves[0], set->curves[0]);
  const auto program = curves::compile_function(*square);
  float out[5];
  program->evaluate_grid({0, 1, 4}, 0, out);
  for (const float value : out) std::printf("%g ", double(value));
}
