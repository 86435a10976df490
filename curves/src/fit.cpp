// SPDX-License-Identifier: MIT
#include "knotwave/curves/fit.h"

#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/base/elementary.h"
#include "knotwave/base/index.h"

#include "chords.h"
#include "fitted_curve.h"
#include "length.h"
#include "spline_fit.h"

namespace knotwave::curves {
namespace {

using base::index_of;

Result<void> check_degree(const std::string& what, int degree) {
  if (degree >= 1 && degree <= kMaxDegree) return {};
  return fail(ErrorCode::degree_out_of_range, what + ": degree " + std::to_string(degree) +
                                                  " is outside 1.." + std::to_string(kMaxDegree));
}

Result<void> check_count(const std::string& what, int degree, std::size_t count) {
  if (count > index_of(kMaxPoints)) {
    return fail(ErrorCode::too_many_points, what + ": " + std::to_string(count) +
                                                " points, at most " + std::to_string(kMaxPoints) +
                                                " are possible");
  }
  if (count > index_of(degree)) return {};
  return fail(ErrorCode::too_few_points, what + ": degree " + std::to_string(degree) + " needs " +
                                             std::to_string(degree + 1) + " points, found " +
                                             std::to_string(count));
}

// (9.68), (9.69): as many parameters in every span, about.
std::vector<double> shared_out_knots(std::span<const double> parameters, int p, int count) {
  const DoubleDouble step = DoubleDouble(static_cast<double>(parameters.size())) /
                            DoubleDouble(static_cast<double>(count - p));
  std::vector<double> inner;
  for (int j = 1; j < count - p; ++j) {
    const double place = (DoubleDouble(j) * step).hi, whole = std::floor(place);
    const std::size_t i = static_cast<std::size_t>(whole);
    const double low = parameters[i - 1], high = parameters[i];
    inner.push_back(low + (place - whole) * (high - low));
  }
  return clamped_knots(parameters.front(), inner, parameters.back(), p);
}

Result<std::vector<double>> spaced_parameters(const std::string& what,
                                              std::span<const double> points, int dim,
                                              Spacing spacing) {
  std::vector<double> parameters{0};
  for (const double chord : chords(points, dim)) {
    const double step = spacing == Spacing::uniform ? 1
                        : spacing == Spacing::chord ? chord
                                                    : std::sqrt(chord);
    if (!(step > 0)) {
      return fail(ErrorCode::knots_decrease, what + ": points " +
                                                 std::to_string(parameters.size() - 1) + " and " +
                                                 std::to_string(parameters.size()) +
                                                 " are at the same place; only uniform spacing "
                                                 "has a step between them");
    }
    parameters.push_back(parameters.back() + step);
  }
  const double total = parameters.back();
  for (double& parameter : parameters) parameter /= total;
  return parameters;
}

double largest_miss(const NurbsCurve& curve, const Samples& samples) {
  const std::size_t size = index_of(curve.dim());
  double largest = 0;
  for (std::size_t i = 0; i < samples.at.size(); ++i) {
    double apart[kMaxDim];
    curve.evaluate(samples.at[i], std::span(apart).first(size));
    for (std::size_t c = 0; c < size; ++c) apart[c] -= samples.values[i * size + c];
    largest = std::max(largest, length_of({apart, size}));
  }
  return largest;
}

}  // namespace

Result<NurbsCurve> curve_of(std::string name, Spline spline) {
  CurveSpec spec;
  spec.name = std::move(name);
  spec.degree = spline.degree;
  spec.dim = spline.dim;
  spec.points = std::move(spline.points);
  spec.knots = std::move(spline.knots);
  return NurbsCurve::create(std::move(spec));
}

FittedCurve fitted_curve(NurbsCurve curve, std::span<const double> values, double max_error) {
  double largest = 0;
  const std::size_t size = index_of(curve.dim());
  for (std::size_t i = 0; i < values.size(); i += size) {
    largest = std::max(largest, length_of(values.subspan(i, size)));
  }
  const double db = max_error > 0 && largest > 0 ? base::gain_to_db(max_error / largest) : -1000;
  return {std::move(curve), max_error, db};
}

Result<NurbsCurve> interpolate(std::span<const double> points, int dim, int degree,
                               Spacing spacing) {
  const std::string what = "interpolation";
  if (dim < 1 || dim > kMaxDim || points.size() % index_of(dim) != 0) {
    return fail(ErrorCode::dimension_mismatch, what + ": " + std::to_string(points.size()) +
                                                   " numbers are no points with " +
                                                   std::to_string(dim) + " coordinates");
  }
  if (points.size() < 2 * index_of(dim)) {
    return fail(ErrorCode::too_few_points, what + " needs 2 points or more");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::isfinite(points[i])) continue;
    return fail(ErrorCode::not_finite,
                what + ": point " + std::to_string(i / index_of(dim)) + " is not finite");
  }
  const auto parameters = spaced_parameters(what, points, dim, spacing);
  if (!parameters) return parameters.error();
  return interpolate_at(*parameters, points, dim, degree);
}

Result<NurbsCurve> interpolate_at(std::span<const double> parameters,
                                  std::span<const double> points, int dim, int degree) {
  const std::string what = "interpolation";
  const Samples samples{parameters, points};
  if (auto good = check_degree(what, degree); !good) return good.error();
  if (auto good = check_samples(what, samples, dim); !good) return good.error();
  if (auto good = check_count(what, degree, parameters.size()); !good) return good.error();
  Spline spline{degree, dim, averaged_knots(parameters, degree), {}};
  if (!interpolate_points(spline, samples)) {
    return fail(ErrorCode::knots_decrease,
                what + ": the parameters are too close for knots between them");
  }
  return curve_of("interpolated", std::move(spline));
}

Result<FittedCurve> approximate(std::span<const double> parameters, std::span<const double> values,
                                int dim, int degree, int point_count) {
  const std::string what = "approximation";
  const Samples samples{parameters, values};
  if (auto good = check_degree(what, degree); !good) return good.error();
  if (auto good = check_samples(what, samples, dim); !good) return good.error();
  if (point_count > 0 && index_of(point_count) > parameters.size()) {
    return fail(ErrorCode::too_many_points, what + ": " + std::to_string(point_count) +
                                                " points for " + std::to_string(parameters.size()) +
                                                " data");
  }
  if (auto good = check_count(what, degree, index_of(std::max(point_count, 0))); !good) {
    return good.error();
  }
  Spline spline{degree, dim, {}, std::vector<double>(index_of(point_count * dim))};
  const bool through_all = index_of(point_count) == parameters.size();
  spline.knots = through_all ? averaged_knots(parameters, degree)
                             : shared_out_knots(parameters, degree, point_count);
  std::copy_n(values.begin(), dim, spline.points.begin());
  std::copy_n(values.end() - dim, dim, spline.points.end() - dim);
  const bool settled = through_all ? interpolate_points(spline, samples)
                                   : fit_points(spline, samples, 1, point_count - 2);
  if (!settled) {
    return fail(ErrorCode::knots_decrease,
                what + ": the parameters are too close for knots between them");
  }
  auto curve = curve_of("approximated", std::move(spline));
  if (!curve) return std::move(curve).error();
  const double max_error = largest_miss(*curve, samples);
  return fitted_curve(std::move(*curve), values, max_error);
}

}  // namespace knotwave::curves
