// SPDX-License-Identifier: MIT
// Weighted points of a surface in double-double, rounded once when they become one. Private to
// curves. [control]
#pragma once
#include <string>
#include <vector>

#include "knotwave/curves/nurbs_surface.h"

#include "homogeneous.h"

namespace knotwave::curves {

/// A surface on its way to its points.
struct HomogeneousNet {
  SurfaceSpec spec;                      ///< name, dim, degrees and knots
  std::vector<HomogeneousPoint> points;  ///< rows of u, one a v

  HomogeneousNet(std::string name, int dim);
  void set_u(int degree, std::vector<double> knots, bool periodic = false);
  void set_v(int degree, std::vector<double> knots);
  /// Errors: weight_not_positive, weight_out_of_range, those of NurbsSurface::create().
  Result<NurbsSurface> finish() &&;
};

}  // namespace knotwave::curves
