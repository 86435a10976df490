// SPDX-License-Identifier: MIT
// Degree elevation is the product with a 1 of that degree: point j of degree p + t is the mean of
// f over its p + t knots, each t of them left out once (A5.9 goes by way of Bézier segments).
#include <cstdint>
#include <string>

#include "knotwave/curves/algorithms.h"

#include "spline_product.h"

namespace knotwave::curves {

Result<NurbsCurve> elevate_degree(const NurbsCurve& curve, int times) {
  if (times < 0) {
    return fail(ErrorCode::value_out_of_range, "curve '" + curve.name() +
                                                   "': a degree cannot be elevated " +
                                                   std::to_string(times) + " times");
  }
  if (times > kMaxDegree - curve.degree()) {
    return fail(ErrorCode::degree_out_of_range,
                "curve '" + curve.name() + "': degree " +
                    std::to_string(std::int64_t{curve.degree()} + times) + " is outside 1.." +
                    std::to_string(kMaxDegree));
  }
  return times == 0 ? curve : multiply_by_one(curve, times);
}

}  // namespace knotwave::curves
