// SPDX-License-Identifier: MIT
// Crossfade laws from curves.
#include <array>
#include <string>

#include "knotwave/curves/compile.h"
#include "knotwave/dsp/crossfade.h"

namespace knotwave::dsp {

CrossfadeLaw CrossfadeLaw::linear() {
  CrossfadeLaw law;
  law.kind_ = Kind::equal_gain;
  return law;
}

Result<CrossfadeLaw> CrossfadeLaw::create(const curves::NurbsCurve& curve,
                                          const curves::CompileOptions& options) {
  if (curve.dim() > 2) {
    return fail(ErrorCode::not_scalar,
                "a crossfade law has 1 coordinate (the gain of b) or 2 (the gains of a and b), "
                "this curve has " +
                    std::to_string(curve.dim()));
  }
  auto program = curves::compile_parametric(curve, options);
  if (!program) return program.error();
  CrossfadeLaw law;
  law.kind_ = Kind::curve;
  law.program_ = std::move(*program);
  return law;
}

GainPair CrossfadeLaw::at(double position, std::span<const double> controls) const KNOTWAVE_RT {
  if (kind_ == Kind::equal_power) return equal_power(position);
  if (kind_ == Kind::equal_gain) return equal_gain(position);
  const double p = position > 0 ? (position < 1 ? position : 1.0) : 0.0;
  const double width = program_.u_max() - program_.u_min();
  const double u = program_.u_min() + p * width;
  if (program_.dim() == 2) {
    return {static_cast<float>(program_.at_u(u, 0, controls)),
            static_cast<float>(program_.at_u(u, 1, controls))};
  }
  const double mirrored = program_.u_min() + (1 - p) * width;
  return {static_cast<float>(program_.at_u(mirrored, 0, controls)),
          static_cast<float>(program_.at_u(u, 0, controls))};
}

void CrossfadeLaw::render(std::span<const double> position, std::span<const double* const> controls,
                          std::span<float> a, std::span<float> b) const KNOTWAVE_RT {
  if (kind_ == Kind::equal_power) {
    equal_power(position, a, b);
    return;
  }
  const auto count = static_cast<std::size_t>(program_.control_count());
  const std::size_t moved = controls.size() >= count ? count : 0;
  std::array<double, curves::kMaxControls> now{};
  for (std::size_t i = 0; i < position.size(); ++i) {
    for (std::size_t k = 0; k < moved; ++k) now[k] = controls[k][i];
    const GainPair gains = at(position[i], std::span<const double>(now).first(moved));
    a[i] = gains.a;
    b[i] = gains.b;
  }
}

}  // namespace knotwave::dsp
