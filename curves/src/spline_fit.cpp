// SPDX-License-Identifier: MIT

#include "spline_fit.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"

#include "span_basis.h"

namespace knotwave::curves {
namespace {

using base::index_of;

// Square, at most `band` numbers to either side of the diagonal that are not 0.
class BandMatrix {
 public:
  BandMatrix(int size, int band)
      : size_(size), band_(band), numbers_(index_of(size) * index_of(2 * band + 1)) {}

  DoubleDouble& at(int row, int column) {
    return numbers_[index_of(row) * index_of(2 * band_ + 1) + index_of(column - row + band_)];
  }

  // Elimination without pivots; `right` [size*columns] becomes the solution. False if a pivot is
  // not positive, as those of totally positive and of positive definite matrices are.
  bool solve(std::vector<DoubleDouble>& right, int columns) {
    for (int k = 0; k < size_; ++k) {
      const DoubleDouble pivot = at(k, k);
      if (!(pivot.hi > 0)) return false;
      for (int i = k + 1; i < std::min(size_, k + band_ + 1); ++i) {
        const DoubleDouble share = at(i, k) / pivot;
        if (share.hi == 0) continue;
        for (int j = k + 1; j < std::min(size_, k + band_ + 1); ++j) {
          at(i, j) = at(i, j) - share * at(k, j);
        }
        for (int c = 0; c < columns; ++c) {
          DoubleDouble& number = right[index_of(i * columns + c)];
          number = number - share * right[index_of(k * columns + c)];
        }
      }
    }
    for (int k = size_ - 1; k >= 0; --k) {
      for (int c = 0; c < columns; ++c) {
        DoubleDouble sum = right[index_of(k * columns + c)];
        for (int j = k + 1; j < std::min(size_, k + band_ + 1); ++j) {
          sum = sum - at(k, j) * right[index_of(j * columns + c)];
        }
        right[index_of(k * columns + c)] = sum / at(k, k);
      }
    }
    return true;
  }

 private:
  int size_;
  int band_;
  std::vector<DoubleDouble> numbers_;
};

// The degree + 1 basis functions at u, which begin with that of point `first`.
struct BasisRow {
  BasisRow(const Spline& spline, double u)
      : span(find_span(spline.knots, spline.degree, u, Side::right)),
        first(span - spline.degree),
        basis(KnotSequence{spline.knots, spline.degree, false}, span, u),
        values(basis.rows[spline.degree]) {}

  int span;
  int first;
  SpanBasis basis;
  const DoubleDouble* values;
};

void keep_solution(Spline& spline, int first, const std::vector<DoubleDouble>& solution) {
  for (std::size_t i = 0; i < solution.size(); ++i) {
    spline.points[index_of(first * spline.dim) + i] = solution[i].hi;
  }
}

}  // namespace

Result<void> check_samples(const std::string& what, const Samples& samples, int dim) {
  using base::number_text;
  if (dim < 1 || dim > kMaxDim || samples.values.size() != samples.at.size() * index_of(dim)) {
    return fail(ErrorCode::dimension_mismatch,
                what + ": " + std::to_string(samples.at.size()) + " parameters and " +
                    std::to_string(samples.values.size()) + " numbers do not make points with " +
                    std::to_string(dim) + " coordinates (1.." + std::to_string(kMaxDim) + ")");
  }
  for (std::size_t i = 0; i < samples.values.size(); ++i) {
    if (std::isfinite(samples.values[i])) continue;
    return fail(ErrorCode::not_finite,
                what + ": point " + std::to_string(i / index_of(dim)) + " is not finite");
  }
  for (std::size_t i = 0; i < samples.at.size(); ++i) {
    if (!std::isfinite(samples.at[i])) {
      return fail(ErrorCode::not_finite,
                  what + ": parameter " + std::to_string(i) + " is not finite");
    }
    if (i == 0 || samples.at[i] > samples.at[i - 1]) continue;
    return fail(ErrorCode::knots_decrease, what + ": parameter " + std::to_string(i) + " (" +
                                               number_text(samples.at[i]) +
                                               ") is not above parameter " + std::to_string(i - 1) +
                                               " (" + number_text(samples.at[i - 1]) + ")");
  }
  return {};
}

bool fit_points(Spline& spline, const Samples& samples, int first, int last) {
  const int p = spline.degree, dim = spline.dim, size = last - first + 1;
  if (size < 1) return true;
  BandMatrix matrix(size, p);
  std::vector<DoubleDouble> right(index_of(size * dim));
  const auto begin =
      std::lower_bound(samples.at.begin(), samples.at.end(), spline.knots[index_of(first)]);
  const auto end = std::upper_bound(begin, samples.at.end(), spline.knots[index_of(last + p + 1)]);
  for (auto sample = begin; sample != end; ++sample) {
    const BasisRow row(spline, *sample);
    const auto value = index_of(static_cast<int>(sample - samples.at.begin()) * dim);
    DoubleDouble rest[kMaxDim];
    for (int c = 0; c < dim; ++c) rest[c] = samples.values[value + index_of(c)];
    for (int r = 0; r <= p; ++r) {
      const int i = row.first + r;
      if (i >= first && i <= last) continue;
      for (int c = 0; c < dim; ++c) {
        rest[c] = rest[c] - row.values[r] * DoubleDouble(spline.points[index_of(i * dim + c)]);
      }
    }
    for (int r = std::max(0, first - row.first); r <= std::min(p, last - row.first); ++r) {
      const int i = row.first + r - first;
      for (int s = std::max(0, first - row.first); s <= std::min(p, last - row.first); ++s) {
        matrix.at(i, row.first + s - first) += row.values[r] * row.values[s];
      }
      for (int c = 0; c < dim; ++c) right[index_of(i * dim + c)] += row.values[r] * rest[c];
    }
  }
  if (!matrix.solve(right, dim)) return false;
  keep_solution(spline, first, right);
  return true;
}

bool solve_interpolation(const Spline& frame, std::span<const double> at,
                         std::vector<DoubleDouble>& values, int columns) {
  const int p = frame.degree, count = frame.count();
  BandMatrix matrix(count, p);
  for (int i = 0; i < count; ++i) {
    const BasisRow row(frame, at[index_of(i)]);
    for (int r = 0; r <= p; ++r) {
      const int column = row.first + r;
      if (std::abs(column - i) <= p) matrix.at(i, column) = row.values[r];
    }
  }
  return matrix.solve(values, columns);
}

bool interpolate_points(Spline& spline, const Samples& samples) {
  std::vector<DoubleDouble> right(samples.values.begin(), samples.values.end());
  if (!solve_interpolation(spline, samples.at, right, spline.dim)) return false;
  spline.points.assign(right.size(), 0.0);
  keep_solution(spline, 0, right);
  return true;
}

std::vector<double> clamped_knots(double low, const std::vector<double>& inner, double high,
                                  int p) {
  std::vector<double> knots(index_of(p + 1), low);
  knots.insert(knots.end(), inner.begin(), inner.end());
  knots.insert(knots.end(), index_of(p + 1), high);
  return knots;
}

std::vector<double> averaged_knots(std::span<const double> parameters, int p) {
  std::vector<double> inner;
  for (std::size_t j = 1; j + index_of(p) < parameters.size(); ++j) {
    DoubleDouble sum = 0.0;
    for (std::size_t i = j; i < j + index_of(p); ++i) sum += DoubleDouble(parameters[i]);
    inner.push_back((sum / DoubleDouble(p)).hi);
  }
  return clamped_knots(parameters.front(), inner, parameters.back(), p);
}

}  // namespace knotwave::curves
