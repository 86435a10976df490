// SPDX-License-Identifier: MIT
// Shapers whose curve has numbers that move: the mean by Gauss and Legendre's rule.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "knotwave/base/document.h"
#include "knotwave/base/gauss_legendre.h"
#include "knotwave/dsp/shaper.h"

namespace knotwave::dsp {
namespace {

constexpr int kMostPieces = 64;     // each may be crossed within one sample
constexpr double kMaxError = 3e-8;  // of a piece's mean: -150 dB, as for shapers at rest

constexpr auto& kNodes = base::kGaussLegendre16;
constexpr std::size_t kPairs = std::size(kNodes);

// Mean of the curve over [x0, x1] of one piece.
double gauss_mean(const curves::CurveProgram& curve, double x0, double x1,
                  std::span<const double> controls) {
  const double middle = 0.5 * (x0 + x1), width = x1 - x0;
  std::array<double, 2 * kPairs> x, y;
  for (std::size_t i = 0; i < kPairs; ++i) {
    x[2 * i] = middle - width * kNodes[i].distance;
    x[2 * i + 1] = middle + width * kNodes[i].distance;
  }
  std::array<std::array<double, 2 * kPairs>, curves::kMaxControls> values;
  std::array<const double*, curves::kMaxControls> moved;
  for (std::size_t k = 0; k < controls.size(); ++k) {
    values[k].fill(controls[k]);
    moved[k] = values[k].data();
  }
  curves::CurveCursor cursor;
  if (controls.empty()) {
    curve.render(x, y, cursor);
  } else {
    curve.render(x, std::span(moved).first(controls.size()), y, cursor);
  }
  double sum = 0;
  for (std::size_t i = 0; i < kPairs; ++i) sum += kNodes[i].weight * (y[2 * i] + y[2 * i + 1]);
  return sum;
}

// How far the mean of a piece is from that of its halves, with every control at an end of its
// range.
double worst_difference(const curves::CurveProgram& curve, double x0, double x1) {
  const auto count = static_cast<std::size_t>(curve.control_count());
  const double middle = 0.5 * (x0 + x1);
  double worst = 0;
  for (unsigned corner = 0; corner < 1U << count; ++corner) {
    std::array<double, curves::kMaxControls> values{};
    for (std::size_t k = 0; k < count; ++k) {
      const int control = static_cast<int>(k);
      values[k] =
          (corner >> k & 1U) != 0 ? curve.control_high(control) : curve.control_low(control);
    }
    const std::span<const double> controls = std::span<const double>(values).first(count);
    const double halves =
        0.5 * (gauss_mean(curve, x0, middle, controls) + gauss_mean(curve, middle, x1, controls));
    worst = std::max(worst, std::abs(gauss_mean(curve, x0, x1, controls) - halves));
  }
  return worst;
}

}  // namespace

Result<ShaperProgram> ShaperProgram::create_moving(const curves::NurbsCurve& curve,
                                                   std::span<const curves::ControlRange> controls) {
  for (const curves::ControlRange& control : controls) {
    if (control.kind != curves::ControlRange::Kind::knot) continue;
    return fail(ErrorCode::unsupported,
                "curve '" + curve.name() + "': knot " + std::to_string(control.point) +
                    " of it moves; a shaper can follow points and weights, not knots");
  }
  curves::CompileOptions options;
  options.controls.assign(controls.begin(), controls.end());
  auto program = curves::compile_function(curve, options);
  if (!program) return program.error();
  ShaperProgram shaper;
  shaper.moving_ = *std::move(program);
  shaper.max_error_ = shaper.moving_.max_error();
  const auto breaks = shaper.moving_.breaks();
  std::vector<double> ends(breaks.rbegin(), breaks.rend());  // those to come, the nearest last
  shaper.breaks_.push_back(ends.back());
  ends.pop_back();
  while (!ends.empty()) {
    const double x0 = shaper.breaks_.back(), x1 = ends.back();
    const double error = worst_difference(shaper.moving_, x0, x1);
    if (shaper.breaks_.size() + ends.size() > kMostPieces + 1) {
      return fail(ErrorCode::error_bound_missed,
                  "curve '" + curve.name() + "' with its moved numbers needs more than " +
                      std::to_string(kMostPieces) +
                      " pieces as a shaper; fewer points, or weights that move less far, work");
    }
    if (error > kMaxError) {
      ends.push_back(0.5 * (x0 + x1));
      continue;
    }
    shaper.max_error_ = std::max(shaper.max_error_, error);
    shaper.breaks_.push_back(x1);
    ends.pop_back();
  }
  shaper.pieces_ = static_cast<int>(shaper.breaks_.size()) - 1;
  return shaper;
}

// From piece to piece; below and above the domain the ends hold.
double ShaperProgram::moving_mean(Input a, Input b,
                                  std::span<const double> controls) const KNOTWAVE_RT {
  if (b.x < a.x) std::swap(a, b);
  const auto part = [&](int piece, double x0, double x1) KNOTWAVE_RT {
    if (piece < 0) return moving_.at_u(moving_.u_min(), 0, controls);
    if (piece >= pieces_) return moving_.at_u(moving_.u_max(), 0, controls);
    return gauss_mean(moving_, x0, x1, controls);
  };
  if (a.piece == b.piece) return part(a.piece, a.x, b.x);
  double sum = 0, x0 = a.x;
  for (int piece = a.piece; piece <= b.piece; ++piece) {
    const double x1 = piece < b.piece ? breaks_[static_cast<std::size_t>(piece) + 1] : b.x;
    sum += (x1 - x0) * part(piece, x0, x1);
    x0 = x1;
  }
  return sum / (b.x - a.x);
}

}  // namespace knotwave::dsp
