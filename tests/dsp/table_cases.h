// SPDX-License-Identifier: MIT
// Tables that several tests make, and how far two are apart.
#pragma once
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "knotwave/curves/nurbs_surface.h"
#include "knotwave/dsp/wave_tables.h"

namespace knotwave::test {

using curves::CurveSpec;
using curves::NurbsCurve;
using curves::NurbsSurface;
using curves::SurfaceSpec;
using dsp::WaveTableOptions;
using dsp::WaveTables;

inline WaveTables made(Result<WaveTables> tables) {
  EXPECT_TRUE(tables) << tables.error().message;
  return tables ? *tables : WaveTables();
}

inline WaveTables of_curve(const CurveSpec& spec, const WaveTableOptions& options = {}) {
  const auto curve = NurbsCurve::create(spec);
  EXPECT_TRUE(curve) << curve.error().message;
  return made(WaveTables::create(*curve, options));
}

inline base::Phase turn(double cycles) { return base::phase_from_cycles(cycles); }

/// A morph of four different closed shapes; with weights it is rational.
inline NurbsSurface morph(bool rational, int degree_v = 3) {
  SurfaceSpec spec;
  spec.name = "morph";
  spec.count_u = 12;
  spec.count_v = degree_v + 3;
  spec.degree_v = degree_v;
  spec.periodic_u = true;
  for (int k = 0; k < spec.count_u * spec.count_v; ++k) {
    spec.points.push_back(((k * 53) % 29 - 14) / 14.0);
    if (rational) spec.weights.push_back(k % 5 == 0 ? 4.0 : 1.0);
  }
  auto surface = NurbsSurface::create(spec);
  EXPECT_TRUE(surface) << surface.error().message;
  return *surface;
}

/// Largest difference of the tables at a position from those of the curve there, all harmonics.
inline double difference(const WaveTables& tables, double position, const WaveTables& truth) {
  double worst = 0;
  const auto blend = tables.blend_at(position);
  for (int k = 0; k < 257; ++k) {
    const base::Phase phase = turn(k / 257.0);
    worst = std::max(worst, double(std::abs(tables.read(tables.level_count() - 1, blend, 0, phase) -
                                            truth.read(truth.level_count() - 1, {}, 0, phase))));
  }
  return worst;
}

}  // namespace knotwave::test
