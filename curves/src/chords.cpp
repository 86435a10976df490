// SPDX-License-Identifier: MIT
#include "chords.h"

#include <cmath>

#include "knotwave/base/index.h"

namespace knotwave::curves {

std::vector<double> chords(std::span<const double> points, int dim) {
  const std::size_t size = base::index_of(dim);
  std::vector<double> lengths;
  for (std::size_t i = size; i < points.size(); i += size) {
    double square = 0;
    for (std::size_t c = i; c < i + size; ++c) {
      const double along = points[c] - points[c - size];
      square += along * along;
    }
    lengths.push_back(std::sqrt(square));
  }
  return lengths;
}

}  // namespace knotwave::curves
