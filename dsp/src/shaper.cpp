// SPDX-License-Identifier: MIT
#include "knotwave/dsp/shaper.h"

#include <algorithm>
#include <array>

#include "knotwave/base/fit_input.h"
#include "knotwave/base/index.h"

namespace knotwave::dsp {
namespace {

using base::index_of;

constexpr double kMaxError = 3e-8;  // of the polynomial form: -150 dB

// With a = t(x0), b = t(x1) the mean of t^k over [a, b] is h_k(a, b) / (k + 1), where
// h_k = a^k + a^(k-1) b + ... + b^k = a h_(k-1) + b^k. The blossom of the antiderivative, in short.
template <int Degree>
double mean_of(const double* terms, double a, double b) {
  double power = 1, h = 1;
  double sum = terms[0];
  for (int k = 1; k <= Degree; ++k) {
    power *= b;
    h = a * h + power;
    sum += terms[k] * h;
  }
  return sum;
}

Result<curves::CurveProgram> polynomial_program(const curves::NurbsCurve& curve) {
  curves::CompileOptions options;
  options.max_error = kMaxError;
  if (curve.dim() == 1) return curves::compile_polynomial(curve, options);
  auto program = curves::compile_function(curve, options);
  if (program && program->is_rational()) {
    return fail(ErrorCode::unsupported,
                "curve '" + curve.name() +
                    "' does not become plain polynomials of its x; a shaper needs them. Without "
                    "weights, or as a 1-D curve, it works");
  }
  return program;
}

}  // namespace

Result<ShaperProgram> ShaperProgram::create(const curves::NurbsCurve& curve,
                                            std::span<const curves::ControlRange> controls) {
  if (!controls.empty()) return create_moving(curve, controls);
  const auto program = polynomial_program(curve);
  if (!program) return program.error();
  ShaperProgram shaper;
  shaper.pieces_ = program->piece_count();
  shaper.degree_ = program->piece_degree();
  shaper.max_error_ = program->max_error();
  shaper.breaks_.assign(program->breaks().begin(), program->breaks().end());
  double area = 0, lost = 0;  // Kahan's sum
  shaper.area_.push_back(0);
  for (int piece = 0; piece < shaper.pieces_; ++piece) {
    const double width = shaper.breaks_[index_of(piece) + 1] - shaper.breaks_[index_of(piece)];
    shaper.inverse_widths_.push_back(1 / width);
    const auto coefficients = program->coefficients(piece);
    double whole = 0;
    for (std::size_t k = 0; k < coefficients.size(); ++k) {
      shaper.terms_.push_back(coefficients[k] / static_cast<double>(k + 1));
      whole += shaper.terms_.back();
    }
    const double part = whole * width - lost;
    const double sum = area + part;
    lost = (sum - area) - part;
    area = sum;
    shaper.area_.push_back(area);
  }
  const auto first = program->coefficients(0);
  const auto last = program->coefficients(shaper.pieces_ - 1);
  shaper.first_value_ = first[0];
  for (const double c : last) shaper.last_value_ += c;
  return shaper;
}

ShaperProgram::Input ShaperProgram::locate(double x, int hint) const KNOTWAVE_RT {
  x = base::fit_input(x);
  const int near = std::clamp(hint, 0, pieces_ - 1);
  if (breaks_[index_of(near)] <= x && x < breaks_[index_of(near) + 1]) return {x, near};
  const auto after = std::upper_bound(breaks_.begin(), breaks_.end(), x);
  return {x, static_cast<int>(after - breaks_.begin()) - 1};
}

double ShaperProgram::piece_mean(int piece, double x0, double x1) const KNOTWAVE_RT {
  const double start = breaks_[index_of(piece)];
  const double a = (x0 - start) * inverse_widths_[index_of(piece)];
  const double b = (x1 - start) * inverse_widths_[index_of(piece)];
  const double* terms = terms_.data() + index_of(piece) * index_of(degree_ + 1);
  static_assert(curves::kMaxPieceDegree == 7);
  switch (degree_) {
    case 0:
      return terms[0];
    case 1:
      return mean_of<1>(terms, a, b);
    case 2:
      return mean_of<2>(terms, a, b);
    case 3:
      return mean_of<3>(terms, a, b);
    case 4:
      return mean_of<4>(terms, a, b);
    case 5:
      return mean_of<5>(terms, a, b);
    case 6:
      return mean_of<6>(terms, a, b);
    default:
      return mean_of<7>(terms, a, b);
  }
}

double ShaperProgram::mean(Input a, Input b, std::span<const double> controls) const KNOTWAVE_RT {
  return control_count() > 0 ? moving_mean(a, b, controls) : still_mean(a, b);
}

double ShaperProgram::still_mean(Input a, Input b) const KNOTWAVE_RT {
  if (b.x < a.x) std::swap(a, b);
  if (a.piece == b.piece) {
    if (a.piece < 0) return first_value_;
    if (a.piece >= pieces_) return last_value_;
    return piece_mean(a.piece, a.x, b.x);
  }
  // Different pieces, so b.x - a.x is at least one step of double and its parts are exact to
  // rounding: their quotients are fractions of 1.
  double sum = 0;
  const int first_whole = a.piece + 1;
  const int last_whole = b.piece - 1;
  const double left = breaks_[index_of(first_whole)] - a.x;
  sum += left *
         (a.piece < 0 ? first_value_ : piece_mean(a.piece, a.x, breaks_[index_of(first_whole)]));
  if (last_whole >= first_whole)
    sum += area_[index_of(last_whole) + 1] - area_[index_of(first_whole)];
  const double right = b.x - breaks_[index_of(b.piece)];
  sum += right *
         (b.piece >= pieces_ ? last_value_ : piece_mean(b.piece, breaks_[index_of(b.piece)], b.x));
  return sum / (b.x - a.x);
}

double ShaperProgram::at(double x) const KNOTWAVE_RT {
  const Input input = locate(x, 0);
  return mean(input, input, {});
}

double ShaperProgram::mean(double x0, double x1) const KNOTWAVE_RT {
  const Input a = locate(x0, 0);
  return mean(a, locate(x1, a.piece), {});
}

void Shaper::render(const ShaperProgram& program, std::span<const float> drive,
                    std::span<const double* const> controls, float mix, std::span<const float> in,
                    std::span<float> out) KNOTWAVE_RT {
  const auto count = static_cast<std::size_t>(program.control_count());
  const std::size_t moved = controls.size() >= count ? count : 0;
  std::array<double, curves::kMaxControls> now{};
  const double wet = mix > 0 ? std::min(static_cast<double>(mix), 1.0) : 0.0;
  ShaperProgram::Input last = program.locate(last_, last_piece_);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double dry = base::fit_input(static_cast<double>(in[i]));
    const ShaperProgram::Input input =
        program.locate(static_cast<double>(drive[i]) * dry, last.piece);
    for (std::size_t k = 0; k < moved; ++k) now[k] = controls[k][i];
    const double shaped = program.mean(last, input, std::span<const double>(now).first(moved));
    out[i] = static_cast<float>(wet * shaped + (1 - wet) * (0.5 * (dry + last_dry_)));
    last = input;
    last_dry_ = dry;
  }
  last_ = last.x;
  last_piece_ = last.piece;
}

}  // namespace knotwave::dsp
