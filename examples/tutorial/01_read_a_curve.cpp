// SPDX-License-Identifier: MIT
// You learn: how a curve file becomes a curve, and how to ask it for values and slopes.
// Run:       build/release/bin/01_read_a_curve examples/curves/decay.toml
// It prints: the curve's degree and domain, then nine rows of u, value, level in dB and slope.
// Next:      02_hear_it_as_an_envelope.cpp
#include <cstdio>

#include "knotwave/base/elementary.h"
#include "knotwave/curves/curve_file.h"

using namespace knotwave;

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s CURVES.toml\n", argv[0]);
    return 2;
  }
  // Everything that can fail returns a Result: a value, or an error with file, line and column.
  const Result<curves::CurveSet> set = curves::read_curves(argv[1]);
  if (!set) {
    std::fprintf(stderr, "%s\n", set.error().to_string().c_str());
    return 1;
  }
  if (set->curves.empty()) {
    std::fprintf(stderr, "%s holds no curve\n", argv[1]);
    return 1;
  }
  const curves::NurbsCurve& curve = set->curves.front();
  std::printf("%s: degree %d, %d control points, u from %g to %g\n", curve.name().c_str(),
              curve.degree(), curve.point_count(), curve.u_min(), curve.u_max());

  std::printf("%8s %12s %9s %12s\n", "u", "value", "dB", "slope");
  for (int i = 0; i <= 8; ++i) {
    const double u = curve.u_min() + (curve.u_max() - curve.u_min()) * i / 8;
    // Value and first derivative, one number per coordinate; at a knot we take the right side.
    double out[2 * curves::kMaxDim];
    curve.derivatives(u, 1, curves::Side::right, out);
    const double value = out[0];
    const double slope = out[curve.dim()];
    std::printf("%8.4f %12.6f %9.2f %12.6f\n", u, value, base::gain_to_db(value), slope);
  }
  return 0;
}
