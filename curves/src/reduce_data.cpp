// SPDX-License-Identifier: MIT
// Data to a curve with few points and a proved bound. Every knot is at a datum's time, so from one
// datum to the next the curve is one polynomial and the data are one line, and their Bézier points
// bound what is between them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"

#include "curve_distance.h"
#include "fitted_curve.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using base::number_text;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// An upper bound of how far a curve is from a line: its Bézier points' distance from those of the
// line, its coordinates added up. What is far below the tolerance needs no better one.
double polygon_distance(const BezierPiece& curve, const BezierPiece& line, int dim) {
  const std::size_t p = curve.points.size() - 1;
  double largest = 0;
  for (std::size_t j = 0; j <= p; ++j) {
    const HomogeneousPoint on_line =
        blend(line.points[0], line.points[1], static_cast<double>(j), static_cast<double>(p - j));
    double distance = 0;
    for (std::size_t c = 0; c < index_of(dim); ++c) {
      distance += std::abs((curve.points[j].x[c] - on_line.x[c]).hi);
    }
    largest = std::max(largest, distance);
  }
  return largest;
}

class DataReduction {
 public:
  DataReduction(const Samples& data, double tolerance, int degree, int dim)
      : data_(data), dim_(index_of(dim)), tolerance_(tolerance), bounds_(data.at.size() - 1) {
    spline_.degree = degree;
    spline_.dim = dim;
    spline_.knots.assign(index_of(degree + 1), data.at.front());
    spline_.knots.insert(spline_.knots.end(), index_of(degree + 1), data.at.back());
    sample_lines();
  }

  // Knots until the bound holds everywhere.
  Result<void> add_knots();
  // Knots that can be spared, taken out.
  void remove_knots();

  const Spline& spline() const { return spline_; }
  double bound() const { return *std::max_element(bounds_.begin(), bounds_.end()); }

 private:
  void sample_lines();
  bool fit_all();
  std::vector<double> measure(const Spline& spline, int first, int last) const;
  bool remove_knot(int knot);
  void split_failing_spans();

  std::span<const double> datum(std::size_t i) const {
    return data_.values.subspan(i * dim_, dim_);
  }
  void add_sample(double at, std::size_t line);
  bool take_lines();
  bool fit(Spline& spline, int first, int last) const;

  Samples data_;
  std::size_t dim_;
  double tolerance_;
  std::vector<double> at_, values_;  // the lines, with places between the data
  Spline spline_;
  std::vector<double> bounds_;  // one a line
};

// What the line is worth at a place on it as rounded: where data lie close, half an ulp of time is
// much of the way from one to the next.
void DataReduction::add_sample(double at, std::size_t line) {
  at_.push_back(at);
  const auto value = datum(line);
  if (at == data_.at[line]) {
    values_.insert(values_.end(), value.begin(), value.end());
    return;
  }
  const DoubleDouble along = DoubleDouble::difference(at, data_.at[line]) /
                             DoubleDouble::difference(data_.at[line + 1], data_.at[line]);
  for (std::size_t c = 0; c < dim_; ++c) {
    const DoubleDouble rise = DoubleDouble::difference(datum(line + 1)[c], value[c]);
    values_.push_back((DoubleDouble(value[c]) + rise * along).hi);
  }
}

// As many places on each line as it takes to settle a polynomial of the degree there.
void DataReduction::sample_lines() {
  const int between = std::max(spline_.degree, 2);
  for (std::size_t i = 0; i + 1 < data_.at.size(); ++i) {
    const double t = data_.at[i], step = data_.at[i + 1] - t;
    add_sample(t, i);
    for (int k = 1; k <= between; ++k) {
      const double place = t + step * (static_cast<double>(k) / (between + 1));
      if (!(place > at_.back() && place < data_.at[i + 1])) continue;
      add_sample(place, i);
    }
  }
  add_sample(data_.at.back(), data_.at.size() - 1);
}

// Least squares may leave what coordinates can be; the bound is measured with them back in it.
bool DataReduction::fit(Spline& spline, int first, int last) const {
  if (!fit_points(spline, {at_, values_}, first, last)) return false;
  for (double& x : spline.points) x = std::clamp(x, -kMaxCoordinate, kMaxCoordinate);
  return true;
}

bool DataReduction::fit_all() {
  spline_.points.assign(index_of(spline_.count()) * dim_, 0.0);
  std::ranges::copy(datum(0), spline_.points.begin());
  std::ranges::copy(datum(data_.at.size() - 1), spline_.points.end() - std::ptrdiff_t(dim_));
  if (!fit(spline_, 1, spline_.count() - 2)) return false;
  bounds_ = measure(spline_, 0, spline_.count() - 1);
  return true;
}

// Bounds of the lines from knot first + p to knot last + 1: where only points first..last act.
std::vector<double> DataReduction::measure(const Spline& spline, int first, int last) const {
  const int p = spline.degree;
  const double from = spline.knots[index_of(first + p)], to = spline.knots[index_of(last + 1)];
  HomogeneousCurve part;
  part.degree = p;
  part.dim = spline.dim;
  part.domain = {from, to, false};
  for (int i = first; i <= last + p + 1; ++i) {
    part.knots.push_back({0, spline.knots[index_of(i)]});
  }
  for (int i = first; i <= last; ++i) {
    part.points.emplace_back(std::span(spline.points).subspan(index_of(i) * dim_, dim_), 1.0);
  }
  std::vector<double> bounds;
  auto line = std::lower_bound(data_.at.begin(), data_.at.end(), from) - data_.at.begin();
  for (; data_.at[static_cast<std::size_t>(line)] < to; ++line) {
    const auto i = static_cast<std::size_t>(line);
    const Knot left{0, data_.at[i]}, right{0, data_.at[i + 1]};
    const BezierPiece curve = piece_between(part, left, right);
    BezierPiece straight{left, right, {}};
    for (const std::size_t end : {i, i + 1}) {
      straight.points.emplace_back(datum(end), 1.0);
    }
    const double rough = polygon_distance(curve, straight, spline.dim);
    const bool near = rough <= tolerance_ / 16;
    bounds.push_back(near ? rough : distance_bound(curve, straight, spline.dim, kNoLimit));
  }
  return bounds;
}

// Every span with a line out of bounds gets a knot where half of its squared error lies to either
// side: in the middle of an arc, and beside a corner. A span of one line gets its knots once more.
void DataReduction::split_failing_spans() {
  const int p = spline_.degree;
  std::vector<double> added;
  const auto multiplicity = [&](double knot) {
    const auto [low, high] = std::equal_range(spline_.knots.begin(), spline_.knots.end(), knot);
    return static_cast<int>(high - low + std::count(added.begin(), added.end(), knot));
  };
  for (int span = p; span < spline_.count(); ++span) {
    const double from = spline_.knots[index_of(span)], to = spline_.knots[index_of(span + 1)];
    if (!(from < to)) continue;
    const auto first = static_cast<std::size_t>(
        std::lower_bound(data_.at.begin(), data_.at.end(), from) - data_.at.begin());
    const auto end = static_cast<std::size_t>(
        std::lower_bound(data_.at.begin(), data_.at.end(), to) - data_.at.begin());
    double worst = 0, sum = 0;
    for (std::size_t i = first; i < end; ++i) {
      worst = std::max(worst, bounds_[i]);
      sum += bounds_[i] * bounds_[i];
    }
    if (worst <= tolerance_) continue;
    if (end - first == 1) {
      for (const double knot : {from, to}) {
        if (multiplicity(knot) < p) added.push_back(knot);
      }
      continue;
    }
    double before = bounds_[first] * bounds_[first];
    std::size_t place = first + 1;
    while (place + 1 < end && before < sum / 2) {
      before += bounds_[place] * bounds_[place];
      ++place;
    }
    added.push_back(data_.at[place]);
  }
  spline_.knots.insert(spline_.knots.end(), added.begin(), added.end());
  std::sort(spline_.knots.begin(), spline_.knots.end());
}

// The lines themselves, a segment each: what is left where rounding is more than the tolerance, or
// where data lie too close for places between them. False if these are too many points.
bool DataReduction::take_lines() {
  const int p = spline_.degree;
  const std::size_t last = data_.at.size() - 1;
  if (last * index_of(p) + 1 > index_of(kMaxPoints)) return false;
  spline_.knots.assign(index_of(p + 1), data_.at.front());
  spline_.points.assign(datum(0).begin(), datum(0).end());
  for (std::size_t i = 0; i < last; ++i) {
    spline_.knots.insert(spline_.knots.end(), index_of(p), data_.at[i + 1]);
    for (int j = 1; j <= p; ++j) {
      for (std::size_t c = 0; c < dim_; ++c) {
        const DoubleDouble from = DoubleDouble(datum(i)[c]) * DoubleDouble(p - j);
        const DoubleDouble to = DoubleDouble(datum(i + 1)[c]) * DoubleDouble(j);
        spline_.points.push_back(((from + to) / DoubleDouble(p)).hi);
      }
    }
  }
  spline_.knots.push_back(data_.at.back());
  bounds_ = measure(spline_, 0, spline_.count() - 1);
  return true;
}

Result<void> DataReduction::add_knots() {
  while (true) {
    const bool settled = fit_all();
    if (settled && bound() <= tolerance_) return {};
    const std::size_t knots = spline_.knots.size();
    if (settled) split_failing_spans();
    const bool stuck = spline_.knots.size() == knots;
    if (stuck && take_lines()) {
      if (bound() <= tolerance_) return {};
      return fail(ErrorCode::error_bound_missed, "reduced data: the lines can be met within " +
                                                     number_text(bound()) + ", not " +
                                                     number_text(tolerance_));
    }
    if (stuck || spline_.count() > kMaxPoints) {
      return fail(ErrorCode::too_many_points, "reduced data: a tolerance of " +
                                                  number_text(tolerance_) + " needs more than " +
                                                  std::to_string(kMaxPoints) + " points");
    }
  }
}

// Takes knots[knot] out and fits the points around it anew, if the bound still holds.
bool DataReduction::remove_knot(int knot) {
  const int p = spline_.degree;
  Spline fewer = spline_;
  fewer.knots.erase(fewer.knots.begin() + knot);
  const int spare = std::clamp(knot - p / 2 - 1, 1, fewer.count() - 1);
  const auto point = fewer.points.begin() + std::ptrdiff_t(index_of(spare) * dim_);
  fewer.points.erase(point, point + std::ptrdiff_t(dim_));
  const int last_point = fewer.count() - 1;
  // Basis functions knot - p - 1 .. knot - 1 are new; as many again to either side are fitted too.
  const int first = std::max(1, knot - 2 * p - 2), last = std::min(last_point - 1, knot + p);
  if (!fit(fewer, first, last)) return false;
  const int from = std::max(0, first - p), to = std::min(last_point, last + p);
  const std::vector<double> bounds = measure(fewer, from, to);
  if (*std::max_element(bounds.begin(), bounds.end()) > tolerance_) return false;
  const auto begin =
      std::lower_bound(data_.at.begin(), data_.at.end(), fewer.knots[index_of(from + p)]) -
      data_.at.begin();
  std::copy(bounds.begin(), bounds.end(), bounds_.begin() + begin);
  spline_ = std::move(fewer);
  return true;
}

void DataReduction::remove_knots() {
  constexpr int kMostPasses = 2;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    bool removed = false;
    for (int knot = spline_.degree + 1; knot < spline_.count();) {
      const bool spared = remove_knot(knot);
      removed = removed || spared;
      if (!spared) ++knot;
    }
    if (!removed) return;
  }
}

// Points outside could be clamped, a datum could not be met.
Result<void> check_range(const std::string& what, std::span<const double> values, int dim) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::abs(values[i]) <= kMaxCoordinate) continue;
    return fail(ErrorCode::coordinate_out_of_range,
                what + ": datum " + std::to_string(i / index_of(dim)) + " (" +
                    number_text(values[i]) + ") is outside -" + number_text(kMaxCoordinate) + ".." +
                    number_text(kMaxCoordinate));
  }
  return {};
}

}  // namespace

Result<FittedCurve> reduce_data(std::span<const double> times, std::span<const double> values,
                                double tolerance, int degree, int dim) {
  const std::string what = "reduced data";
  const Samples data{times, values};
  if (degree < 1 || degree > kMaxDegree) {
    return fail(ErrorCode::degree_out_of_range, what + ": degree " + std::to_string(degree) +
                                                    " is outside 1.." + std::to_string(kMaxDegree));
  }
  if (!(tolerance > 0) || !std::isfinite(tolerance)) {
    return fail(ErrorCode::value_out_of_range,
                what + ": a tolerance of " + number_text(tolerance) + " must be above 0");
  }
  if (auto good = check_samples(what, data, dim); !good) return good.error();
  if (times.size() < 2) {
    return fail(ErrorCode::too_few_points,
                what + ": 2 data or more are needed, found " + std::to_string(times.size()));
  }
  if (auto good = check_range(what, values, dim); !good) return good.error();
  DataReduction reduction(data, tolerance, degree, dim);
  if (auto good = reduction.add_knots(); !good) return good.error();
  reduction.remove_knots();
  auto curve = curve_of("reduced", reduction.spline());
  if (!curve) return std::move(curve).error();
  return fitted_curve(std::move(*curve), values, reduction.bound());
}

}  // namespace knotwave::curves
