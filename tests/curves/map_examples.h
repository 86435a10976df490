// SPDX-License-Identifier: MIT
// What the tests of maps and of their grids both make.
#pragma once
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "knotwave/curves/map.h"

namespace knotwave::test {

inline curves::NurbsCurve bezier(std::vector<double> points, int dim = 1,
                                 std::vector<double> weights = {}) {
  curves::CurveSpec spec;
  spec.name = "example";
  spec.dim = dim;
  spec.degree = static_cast<int>(points.size()) / dim - 1;
  spec.points = std::move(points);
  spec.weights = std::move(weights);
  auto curve = curves::NurbsCurve::create(std::move(spec));
  EXPECT_TRUE(curve) << (curve ? "" : curve.error().message);
  return std::move(*curve);
}

inline curves::NurbsSurface bilinear(std::vector<double> corners,
                                     std::vector<double> weights = {}) {
  curves::SurfaceSpec spec;
  spec.name = "corners";
  spec.degree_u = spec.degree_v = 1;
  spec.count_u = spec.count_v = 2;
  spec.points = std::move(corners);
  spec.weights = std::move(weights);
  auto surface = curves::NurbsSurface::create(std::move(spec));
  EXPECT_TRUE(surface) << (surface ? "" : surface.error().message);
  return std::move(*surface);
}

template <class Map>
curves::MapKey define(curves::MapSet& maps, Map map) {
  auto key = maps.define(std::move(map));
  EXPECT_TRUE(key) << (key ? "" : key.error().message);
  return *key;
}
template <class Map>
curves::MapKey enable(curves::MapSet& maps, Map map) {
  const curves::MapKey key = define(maps, std::move(map));
  EXPECT_TRUE(maps.enable(key));
  return key;
}

inline double number(const curves::MapSet& maps, curves::Target target, double u) {
  curves::MapValues out;
  maps.evaluate(u, out);
  return out.of(target)[0];
}

}  // namespace knotwave::test
