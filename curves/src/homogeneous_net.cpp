// SPDX-License-Identifier: MIT
#include "homogeneous_net.h"

#include "weights.h"

namespace knotwave::curves {

HomogeneousNet::HomogeneousNet(std::string name, int dim) {
  spec.name = std::move(name);
  spec.dim = dim;
}

void HomogeneousNet::set_u(int degree, std::vector<double> knots, bool periodic) {
  spec.degree_u = degree;
  spec.periodic_u = periodic;
  spec.count_u = static_cast<int>(knots.size()) - (periodic ? 1 : degree + 1);
  spec.knots_u = std::move(knots);
}

void HomogeneousNet::set_v(int degree, std::vector<double> knots) {
  spec.degree_v = degree;
  spec.count_v = static_cast<int>(knots.size()) - degree - 1;
  spec.knots_v = std::move(knots);
}

Result<NurbsSurface> HomogeneousNet::finish() && {
  const auto size = static_cast<std::size_t>(spec.dim);
  for (const HomogeneousPoint& point : points) spec.weights.push_back(point.w.hi);
  if (auto fits = fit_weights("surface '" + spec.name + "'", spec.weights); !fits) {
    return fits.error();
  }
  spec.points.resize(points.size() * size);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto out = std::span(spec.points).subspan(i * size, size);
    points[i].project(out);
    for (double& x : out) x += 0.0;  // -0 becomes 0
  }
  return NurbsSurface::create(std::move(spec));
}

}  // namespace knotwave::curves
