// SPDX-License-Identifier: MIT
#include "weights.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/curves/nurbs_curve.h"

namespace knotwave::curves {

using base::number_text;

Result<void> fit_weights(const std::string& what, std::vector<double>& weights) {
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (std::isfinite(weights[i]) && weights[i] > 0) continue;
    std::string message = what + ": weight ";
    message += std::to_string(i) + " (" + number_text(weights[i]) + ")";
    if (std::isfinite(weights[i])) {
      return fail(ErrorCode::weight_not_positive, message + " must be above 0");
    }
    return fail(ErrorCode::not_finite, message + " is not finite");
  }
  const auto [low, high] = std::minmax_element(weights.begin(), weights.end());
  const double least = *low, most = *high;
  if (least >= kMinWeight && most <= kMaxWeight) return {};
  double scale = 1;
  while (most * scale > 1 / (least * scale)) scale /= 2;
  while (most * scale < 1 / (least * scale)) scale *= 2;
  if (most * scale > kMaxWeight) scale /= 2;
  if (least * scale < kMinWeight || most * scale > kMaxWeight) {
    return fail(ErrorCode::weight_out_of_range,
                what + ": the weights would go from " + number_text(least) + " to " +
                    number_text(most) + ", " + number_text(most / least) +
                    " times as much; the limits " + number_text(kMinWeight) + ".." +
                    number_text(kMaxWeight) + " allow " + number_text(kMaxWeight / kMinWeight));
  }
  for (double& weight : weights) weight *= scale;
  return {};
}

}  // namespace knotwave::curves
