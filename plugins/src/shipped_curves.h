// SPDX-License-Identifier: MIT
// Curves of examples/curves/ as the choices of a parameter. [control]
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::plugins {

/// Words and places stay for ever: states and hosts keep them. New ones come at the end.
struct ShippedCurve {
  std::string_view word;  ///< of the choice
  std::string_view path;  ///< among factory_files()
  std::string_view name;  ///< in the file
};

/// "Own", then the words.
std::vector<std::string> curve_choices(std::span<const ShippedCurve> shipped);
/// One that is there, as the tests see to.
curves::NurbsCurve shipped_curve(const ShippedCurve& curve);

/// All of them as `create(curve)` makes them, in their order.
template <class Program, class Create>
std::vector<Program> shipped_programs(std::span<const ShippedCurve> shipped, Create create) {
  std::vector<Program> programs;
  for (const ShippedCurve& curve : shipped) {
    programs.push_back(create(shipped_curve(curve)).value());
  }
  return programs;
}

}  // namespace knotwave::plugins
