// SPDX-License-Identifier: MIT
// Bézier maps from numbers as glMap1 and glMap2 take them.
#include <algorithm>
#include <string>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"
#include "knotwave/curves/map.h"

namespace knotwave::curves {
namespace {

using base::index_of;

std::string name_of(const MapKey& key) { return std::string("map of ") + to_string(key.target); }

/// One direction of the points: `order` of them, `stride` numbers apart.
struct Steps {
  const char* name = "";
  int stride = 1;
  int order = 1;
};

Result<void> check(const MapKey& key, std::span<const Steps> directions, std::size_t have) {
  if (!is_target(key.target)) {
    return fail(ErrorCode::value_out_of_range,
                "map: target " + std::to_string(static_cast<int>(key.target)) + " is outside 0.." +
                    std::to_string(kTargetCount - 1));
  }
  const int size = key.width + (key.rational ? 1 : 0);
  std::size_t needed = index_of(std::max(size, 0));
  if (key.width < 1 || key.width > kMaxDim) {
    return fail(ErrorCode::dimension_mismatch, name_of(key) + ": a point has 1.." +
                                                   std::to_string(kMaxDim) + " coordinates, not " +
                                                   std::to_string(key.width));
  }
  for (const Steps& steps : directions) {
    if (steps.stride < size) {
      return fail(ErrorCode::dimension_mismatch,
                  name_of(key) + ": " + steps.name + "stride " + std::to_string(steps.stride) +
                      " is below the " + std::to_string(size) + " numbers of a point");
    }
    if (steps.order < 2 || steps.order > kMaxDegree + 1) {
      return fail(ErrorCode::degree_out_of_range,
                  name_of(key) + ": " + steps.name + "order " + std::to_string(steps.order) +
                      " is outside 2.." + std::to_string(kMaxDegree + 1));
    }
    needed += index_of(steps.order - 1) * index_of(steps.stride);
  }
  if (have >= needed) return {};
  return fail(ErrorCode::dimension_mismatch, name_of(key) + ": the points end after " +
                                                 std::to_string(have) + " numbers, " +
                                                 std::to_string(needed) + " are needed");
}

/// Appends the point that begins at numbers[0], its weight divided out.
Result<void> take_point(const MapKey& key, std::span<const double> numbers, int index,
                        std::vector<double>& points, std::vector<double>& weights) {
  const std::size_t width = index_of(key.width);
  const double weight = key.rational ? numbers[width] : 1.0;
  if (!(weight > 0)) {
    return fail(ErrorCode::weight_not_positive, name_of(key) + ": point " + std::to_string(index) +
                                                    " has the weight " + base::number_text(weight) +
                                                    ", which is not positive");
  }
  for (std::size_t c = 0; c < width; ++c) points.push_back(numbers[c] / weight);
  if (key.rational) weights.push_back(weight);
  return {};
}

}  // namespace

Result<Map1> bezier_map(const MapKey& key, double u1, double u2, int stride, int order,
                        std::span<const double> points) {
  const Steps steps[] = {{"", stride, order}};
  if (auto ok = check(key, steps, points.size()); !ok) return ok.error();
  CurveSpec spec;
  spec.name = name_of(key);
  spec.degree = order - 1;
  spec.dim = key.width;
  for (int i = 0; i < order; ++i) {
    const auto numbers = points.subspan(index_of(i) * index_of(stride));
    if (auto ok = take_point(key, numbers, i, spec.points, spec.weights); !ok) return ok.error();
  }
  auto curve = NurbsCurve::create(std::move(spec));
  if (!curve) return std::move(curve).error();
  return Map1{key.target, u1, u2, std::move(*curve)};
}

Result<Map2> bezier_map(const MapKey& key, double u1, double u2, int ustride, int uorder, double v1,
                        double v2, int vstride, int vorder, std::span<const double> points) {
  const Steps steps[] = {{"u", ustride, uorder}, {"v", vstride, vorder}};
  if (auto ok = check(key, steps, points.size()); !ok) return ok.error();
  SurfaceSpec spec;
  spec.name = name_of(key);
  spec.degree_u = uorder - 1;
  spec.degree_v = vorder - 1;
  spec.dim = key.width;
  spec.count_u = uorder;
  spec.count_v = vorder;
  for (int j = 0; j < vorder; ++j) {
    for (int i = 0; i < uorder; ++i) {
      const auto numbers =
          points.subspan(index_of(i) * index_of(ustride) + index_of(j) * index_of(vstride));
      if (auto ok = take_point(key, numbers, j * uorder + i, spec.points, spec.weights); !ok) {
        return ok.error();
      }
    }
  }
  auto surface = NurbsSurface::create(std::move(spec));
  if (!surface) return std::move(surface).error();
  return Map2{key.target, u1, u2, v1, v2, std::move(*surface)};
}

}  // namespace knotwave::curves
