// SPDX-License-Identifier: MIT
#include "chords.h"

#include "knotwave/base/index.h"
#include "knotwave/curves/nurbs_curve.h"

#include "length.h"

namespace knotwave::curves {

std::vector<double> chords(std::span<const double> points, int dim) {
  const std::size_t size = base::index_of(dim);
  std::vector<double> lengths;
  for (std::size_t i = size; i < points.size(); i += size) {
    double along[kMaxDim];
    for (std::size_t c = 0; c < size; ++c) along[c] = points[i + c] - points[i + c - size];
    lengths.push_back(length_of({along, size}));
  }
  return lengths;
}

}  // namespace knotwave::curves
