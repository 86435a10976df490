// SPDX-License-Identifier: MIT
// The curve every library evaluates: a clamped uniform cubic with 16 points on [0, 1] (13 spans),
// its weights for the rational form, and the grid. bench/peers/scipy_curve.py has the same.
#pragma once
#include <cmath>
#include <ctime>
#include <vector>

namespace peers {

constexpr int kPoints = 16;
constexpr int kGrid = 65536;  ///< node i is u = i / kGrid

struct Curve {
  std::vector<double> knots;    ///< [kPoints + 4]
  std::vector<double> points;   ///< [kPoints]
  std::vector<double> weights;  ///< [kPoints]
};

inline Curve peer_curve() {
  Curve curve;
  for (int i = 0; i < kPoints + 4; ++i) {
    const int inner = i < 3 ? 0 : i > kPoints ? kPoints - 3 : i - 3;
    curve.knots.push_back(inner / double(kPoints - 3));
  }
  for (int i = 0; i < kPoints; ++i) {
    curve.points.push_back(0.9 * std::sin(1.7 * i + 0.3));
    curve.weights.push_back(1.25 + 0.75 * std::sin(2.9 * i + 1));
  }
  return curve;
}

inline double processor_ns() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e9 * double(now.tv_sec) + double(now.tv_nsec);
}

/// Least processor time in ns a point of `evaluate`, called until about 0.3 s have gone.
template <class Evaluate>
double ns_per_point(const Evaluate& evaluate) {
  evaluate();
  double least = 1e300;
  for (const double begin = processor_ns(); processor_ns() - begin < 3e8;) {
    const double before = processor_ns();
    evaluate();
    const double took = processor_ns() - before;
    if (took < least) least = took;
  }
  return least / kGrid;
}

}  // namespace peers
