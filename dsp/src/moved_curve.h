// SPDX-License-Identifier: MIT
// A curve some of whose numbers move while it is read. Private to dsp.
#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "knotwave/curves/curve_program.h"

namespace knotwave::dsp {

/// out[i] = curve.at_u(u[i]) with control k at controls[k][offset + i], or at rest without
/// controls. [audio] `controls` are fewer than the curve's: at rest.
inline void render_moved(const curves::CurveProgram& curve, std::span<const double> u,
                         std::span<const double* const> controls, std::size_t offset,
                         std::span<double> out, curves::CurveCursor& cursor,
                         int coordinate = 0) KNOTWAVE_RT {
  const auto count = static_cast<std::size_t>(curve.control_count());
  if (count == 0 || controls.size() < count) {
    curve.render(u, out, cursor, coordinate);
    return;
  }
  std::array<const double*, curves::kMaxControls> here;
  for (std::size_t k = 0; k < count; ++k) here[k] = controls[k] + offset;
  curve.render(u, std::span(here).first(count), out, cursor, coordinate);
}

}  // namespace knotwave::dsp
