// SPDX-License-Identifier: MIT
#include "knotwave/dsp/wave_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "knotwave/curves/nurbs_curve.h"
#include "support/spectrum.h"

namespace {

using Complex = std::complex<double>;
using knotwave::ErrorCode;
using knotwave::base::Phase;
using knotwave::curves::CurveSpec;
using knotwave::curves::NurbsCurve;
using knotwave::curves::NurbsSurface;
using knotwave::curves::SurfaceSpec;
using knotwave::dsp::WaveTableOptions;
using knotwave::dsp::WaveTables;

struct Reference {
  std::string name;
  int degree;
  bool periodic;
  std::vector<double> points, knots;
  struct Harmonic {
    int n;
    double re, im;
  };
  std::vector<Harmonic> harmonics;
};
const Reference kReferences[] = {
#include "fourier_reference.inc"
};

NurbsCurve curve_of(const Reference& reference) {
  CurveSpec spec;
  spec.name = reference.name;
  spec.degree = reference.degree;
  spec.periodic = reference.periodic;
  spec.points = reference.points;
  spec.knots = reference.knots;
  if (reference.name.find("jump") != std::string::npos) spec.jumps = {0.5};
  auto curve = NurbsCurve::create(spec);
  EXPECT_TRUE(curve) << curve.error().message;
  return *curve;
}

TEST(FourierCoefficients, AgreeWithSixtyDigitIntegralsWithin200dBOfThePeak) {
  double worst = 0;
  for (const Reference& reference : kReferences) {
    const auto program = knotwave::curves::compile_polynomial(curve_of(reference));
    ASSERT_TRUE(program) << program.error().message;
    const auto found = knotwave::dsp::fourier_coefficients(*program, 0, 2048);
    double error = 0;
    for (const Reference::Harmonic& harmonic : reference.harmonics) {
      const Complex truth(harmonic.re, harmonic.im);
      error = std::max(error, std::abs(found[static_cast<std::size_t>(harmonic.n)] - truth));
    }
    std::printf("%-42s error %.0f dB\n", reference.name.c_str(),
                knotwave::support::decibels(error));
    worst = std::max(worst, error);
  }
  EXPECT_LT(knotwave::support::decibels(worst), -200);
}

}  // namespace
