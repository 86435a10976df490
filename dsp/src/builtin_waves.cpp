// SPDX-License-Identifier: MIT
#include "knotwave/dsp/builtin_waves.h"

#include <algorithm>
#include <array>
#include <string>

#include "knotwave/base/elementary.h"
#include "knotwave/base/suggest.h"

namespace knotwave::dsp {
namespace {

constexpr std::array<std::string_view, 4> kNames = {"sine", "saw", "square", "triangle"};
constexpr double kPi = 3.14159265358979323846;

/// A uniform spline of degree 7 whose points follow a sine is a sine of gain sinc^8(1 / n) with
/// images (n +- 1)^-8 beside it, 6e-10 in all for 16 points.
curves::CurveSpec sine() {
  constexpr int kPoints = 16;
  curves::CurveSpec spec;
  spec.degree = 7;
  spec.periodic = true;
  const double inverse_sinc = kPi / kPoints / base::sin_cos_cycles(0.5 / kPoints).sin;
  double gain = inverse_sinc * inverse_sinc;
  gain = gain * gain;
  gain = gain * gain;
  for (int k = 0; k < kPoints; ++k) {
    // Point k is the peak of the basis function that begins 7 spans before the domain, 4 spans on.
    spec.points.push_back(gain * base::sin_cos_cycles(static_cast<double>(k - 3) / kPoints).sin);
  }
  return spec;
}

curves::CurveSpec shape(std::string_view name) {
  curves::CurveSpec spec;
  spec.degree = 1;
  if (name == "sine") {
    spec = sine();
  } else if (name == "saw") {
    spec.points = {-1, 1};
  } else if (name == "square") {
    spec.points = {1, 1, -1, -1};
    spec.knots = {0, 0, 0.5, 0.5, 1, 1};
    spec.jumps = {0.5};
  } else {
    spec.points = {0, 1, -1, 0};
    spec.knots = {0, 0, 0.25, 0.75, 1, 1};
  }
  spec.name = name;
  return spec;
}

Error unknown(std::string_view name) {
  return fail(ErrorCode::unknown_name, "there is no built-in wave '" + std::string(name) +
                                           "': sine, saw, square or triangle" +
                                           base::suggestion(name, kNames));
}

}  // namespace

std::span<const std::string_view> builtin_wave_names() noexcept { return kNames; }

bool is_builtin_wave(std::string_view name) noexcept {
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

Result<curves::NurbsCurve> builtin_curve(std::string_view name) {
  if (!is_builtin_wave(name)) return unknown(name);
  return curves::NurbsCurve::create(shape(name));
}

Result<WaveTables> builtin_wave(std::string_view name, const WaveTableOptions& options) {
  if (name == "sine") {
    const std::complex<double> fundamental[] = {{0, 0}, {0, -0.5}};
    return WaveTables::create_from_harmonics(fundamental, options);
  }
  const auto curve = builtin_curve(name);
  if (!curve) return curve.error();
  return WaveTables::create(*curve, options);
}

}  // namespace knotwave::dsp
