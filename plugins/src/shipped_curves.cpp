// SPDX-License-Identifier: MIT
#include "shipped_curves.h"

#include "knotwave/curves/curve_file.h"
#include "knotwave/plugins/factory.h"

namespace knotwave::plugins {

std::vector<std::string> curve_choices(std::span<const ShippedCurve> shipped) {
  std::vector<std::string> choices = {"Own"};
  for (const ShippedCurve& curve : shipped) choices.emplace_back(curve.word);
  return choices;
}

curves::NurbsCurve shipped_curve(const ShippedCurve& curve) {
  const auto set = curves::parse_curves(factory_text(curve.path), curve.path).value();
  const curves::NurbsCurve* const found = set.find_curve(curve.name);
  KNOTWAVE_ASSERT(found != nullptr);
  return *found;
}

}  // namespace knotwave::plugins
