// SPDX-License-Identifier: MIT
// Cubic pieces from values and slopes.
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/base/elementary.h"
#include "knotwave/base/index.h"
#include "knotwave/curves/shapes.h"

#include "chords.h"
#include "double_double.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using base::number_text;

Result<void> check_hermite(std::span<const double> times, std::span<const double> values,
                           std::span<const double> slopes_in, std::span<const double> slopes_out,
                           int dim) {
  if (times.size() < 2) {
    return fail(ErrorCode::too_few_points,
                "a Hermite curve needs 2 times or more, found " + std::to_string(times.size()));
  }
  if (dim < 1 || dim > kMaxDim) {
    return fail(ErrorCode::dimension_mismatch, "a Hermite curve with " + std::to_string(dim) +
                                                   " coordinates: 1.." + std::to_string(kMaxDim) +
                                                   " are possible");
  }
  const std::size_t count = times.size() * index_of(dim);
  for (const auto& numbers : {values, slopes_in, slopes_out}) {
    if (numbers.size() == count) continue;
    return fail(ErrorCode::dimension_mismatch,
                "a Hermite curve: " + std::to_string(times.size()) + " times with " +
                    std::to_string(dim) + " coordinates need " + std::to_string(count) +
                    " values and slopes, found " + std::to_string(numbers.size()));
  }
  for (const auto& numbers : {times, values, slopes_in, slopes_out}) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (std::isfinite(numbers[i])) continue;
      return fail(ErrorCode::not_finite, "a Hermite curve: number " + std::to_string(i) + " is " +
                                             number_text(numbers[i]));
    }
  }
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] > times[i - 1]) continue;
    return fail(ErrorCode::knots_decrease, "a Hermite curve: time " + std::to_string(i) + " (" +
                                               number_text(times[i]) + ") is not above time " +
                                               std::to_string(i - 1) + " (" +
                                               number_text(times[i - 1]) + ")");
  }
  return {};
}

// Time steps between neighbours: distances to the power alpha.
std::vector<double> steps_between(std::span<const double> points, int dim, double alpha) {
  std::vector<double> steps;
  for (const double distance : chords(points, dim)) {
    if (alpha == 0) {
      steps.push_back(1);
    } else if (alpha == 0.5) {
      steps.push_back(std::sqrt(distance));
    } else {
      steps.push_back(alpha == 1 || distance == 0 ? distance
                                                  : base::exp2(alpha * base::log2(distance)));
    }
  }
  return steps;
}

// Slope at the middle one of three points: a and b are the secants before and after it, over the
// times h_a and h_b.
double parabola_slope(double a, double b, double h_a, double h_b) {
  return (a * h_b + b * h_a) / (h_a + h_b);
}

// Slopes at all points but the ends, which are left 0.
std::vector<double> inner_slopes(std::span<const double> times, std::span<const double> points,
                                 int dim) {
  const std::size_t size = index_of(dim), last = times.size() - 1;
  std::vector<double> slopes(points.size(), 0.0);
  for (std::size_t i = 1; i < last; ++i) {
    const double before = times[i] - times[i - 1], after = times[i + 1] - times[i];
    for (std::size_t c = 0; c < size; ++c) {
      const double* at = &points[i * size + c];
      slopes[i * size + c] = parabola_slope((at[0] - *(at - size)) / before,
                                            (at[size] - at[0]) / after, before, after);
    }
  }
  return slopes;
}

void set_end_slopes(std::span<const double> times, std::span<const double> points, int dim,
                    bool closed, std::vector<double>& slopes) {
  const std::size_t size = index_of(dim), last = times.size() - 1;
  const auto secant = [&](std::size_t i, std::size_t c) {  // from point i to the next
    return (points[(i + 1) * size + c] - points[i * size + c]) / (times[i + 1] - times[i]);
  };
  const double first_step = times[1] - times[0], last_step = times[last] - times[last - 1];
  for (std::size_t c = 0; c < size; ++c) {
    double& start = slopes[c];
    double& end = slopes[last * size + c];
    const double first = secant(0, c), final = secant(last - 1, c);
    if (closed) {
      start = end = parabola_slope(final, first, last_step, first_step);
      continue;
    }
    // A parabola's secant is its slope half way, so the slope at the end is as far on again.
    start = last == 1 ? first : first + (first - slopes[size + c]);
    end = last == 1 ? final : final + (final - slopes[(last - 1) * size + c]);
  }
}

Result<NurbsCurve> cubic_through(std::string name, std::span<const double> times,
                                 std::span<const double> values, std::span<const double> slopes_in,
                                 std::span<const double> slopes_out, int dim) {
  if (auto good = check_hermite(times, values, slopes_in, slopes_out, dim); !good) {
    return good.error();
  }
  CurveSpec spec;
  spec.name = std::move(name);
  spec.dim = dim;
  const std::size_t size = index_of(dim), last = times.size() - 1;
  const auto add_value = [&](std::size_t i) {
    for (std::size_t c = 0; c < size; ++c) spec.points.push_back(values[i * size + c]);
  };
  // A third of the way from time i to time `to` along the slope at i.
  const auto add_handle = [&](std::size_t i, std::size_t to, std::span<const double> slopes) {
    const DoubleDouble third = DoubleDouble::difference(times[to], times[i]) / DoubleDouble(3.0);
    for (std::size_t c = 0; c < size; ++c) {
      const std::size_t k = i * size + c;
      spec.points.push_back((DoubleDouble(values[k]) + DoubleDouble(slopes[k]) * third).hi);
    }
  };
  spec.knots.assign(4, times[0]);
  add_value(0);
  for (std::size_t i = 0; i < last; ++i) {
    add_handle(i, i + 1, slopes_out);
    add_handle(i + 1, i, slopes_in);
    bool corner = i + 1 == last;
    for (std::size_t c = 0; c < size; ++c) {
      corner = corner || slopes_in[(i + 1) * size + c] != slopes_out[(i + 1) * size + c];
    }
    if (corner) add_value(i + 1);
    spec.knots.insert(spec.knots.end(), i + 1 == last ? 4 : corner ? 3 : 2, times[i + 1]);
  }
  return NurbsCurve::create(std::move(spec));
}

}  // namespace

Result<NurbsCurve> hermite(std::span<const double> times, std::span<const double> values,
                           std::span<const double> slopes_in, std::span<const double> slopes_out,
                           int dim) {
  return cubic_through("hermite", times, values, slopes_in, slopes_out, dim);
}

Result<NurbsCurve> catmull_rom(std::span<const double> points, int dim, double alpha, bool closed) {
  if (dim < 1 || dim > kMaxDim || points.size() % index_of(dim) != 0) {
    return fail(ErrorCode::dimension_mismatch,
                "a Catmull-Rom curve: " + std::to_string(points.size()) +
                    " numbers are no points with " + std::to_string(dim) + " coordinates");
  }
  const std::size_t count = points.size() / index_of(dim), least = closed ? 3 : 2;
  if (count < least) {
    return fail(ErrorCode::too_few_points, "a Catmull-Rom curve needs " + std::to_string(least) +
                                               " points or more, found " + std::to_string(count));
  }
  if (!(alpha >= 0 && alpha <= 1)) {
    return fail(ErrorCode::value_out_of_range,
                "a Catmull-Rom curve: alpha " + number_text(alpha) + " is outside 0..1");
  }
  std::vector<double> all(points.begin(), points.end());
  if (closed) all.insert(all.end(), points.begin(), points.begin() + dim);
  const std::vector<double> steps = steps_between(all, dim, alpha);
  std::vector<double> times{0};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i] == 0) {
      return fail(ErrorCode::knots_decrease,
                  "a Catmull-Rom curve: points " + std::to_string(i) + " and " +
                      std::to_string((i + 1) % count) +
                      " are at the same place; only alpha 0 has time between them");
    }
    times.push_back(times.back() + steps[i]);
  }
  const double total = times.back();
  for (double& time : times) time /= total;
  std::vector<double> slopes = inner_slopes(times, all, dim);
  set_end_slopes(times, all, dim, closed, slopes);
  return cubic_through("catmull-rom", times, all, slopes, slopes, dim);
}

}  // namespace knotwave::curves
