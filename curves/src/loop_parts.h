// SPDX-License-Identifier: MIT
// Closed curves in the plane, cut where one coordinate turns. Private to curves. [control]
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "bernstein.h"
#include "homogeneous.h"

namespace knotwave::curves {

/// A part of a loop over which the coordinate `level` rises, falls or rests throughout, and the
/// other one, `across`; numerators over one weight, in Bernstein form on [0, 1]. Where one part
/// ends and the next begins both ends are the same to the bit.
struct LoopPart {
  Bernstein level;
  Bernstein across;
  Bernstein weight;
  double level0 = 0, level1 = 0;    ///< at the ends, rounded
  double across0 = 0, across1 = 0;  ///< at the ends, rounded
  double low = 0, high = 0;         ///< hull of `across`

  bool rests() const noexcept { return level0 == level1; }
  /// Whether a line at `at` crosses it, moved by nothing to the right (Side::right) or left: so a
  /// corner counts once, twice or never, as the line beside it does.
  bool crosses(double at, Side side) const noexcept;
  /// The other coordinate where the level is `at`, between level0 and level1.
  double across_at(double at) const noexcept;
};

/// Curves that are clamped and end where the next begins. `level`: 0 or 1, the coordinate.
std::vector<LoopPart> loop_parts(std::span<const NurbsCurve> loop, int level);

/// Where loops meet, to 2^-40 of their parts: `first` and `second` name them, near (x, y).
struct Meeting {
  std::size_t first = 0, second = 0;
  double x = 0, y = 0;
};
/// The loops' parts by the same level. A loop may meet itself only where a part goes over into the
/// next one.
std::optional<Meeting> find_meeting(std::span<const std::vector<LoopPart>> loops);

}  // namespace knotwave::curves
