// SPDX-License-Identifier: MIT
#include "compile_controls.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "knotwave/base/document.h"

namespace knotwave::curves {
namespace {

using Kind = ControlRange::Kind;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

int written_points(const CurveSpec& spec) {
  return static_cast<int>(spec.points.size()) / spec.dim;
}

std::string name_of(const NurbsCurve& curve, const ControlRange& control, std::size_t index) {
  std::string name = "curve '" + curve.name() + "': control " + std::to_string(index) + " (";
  if (control.kind == Kind::knot) return name + "knot " + std::to_string(control.point) + ")";
  if (control.kind == Kind::coordinate) {
    name += "coordinate " + std::to_string(control.coordinate) + " of ";
  } else {
    name += "weight of ";
  }
  return name + "point " + std::to_string(control.point) + ")";
}

std::string range_of(const ControlRange& control) {
  return base::number_text(control.low) + ".." + base::number_text(control.high);
}

Result<void> check_rest(const CurveSpec& spec, const ControlRange& control,
                        const std::string& name) {
  const double rest = rest_value(spec, control);
  if (rest >= control.low && rest <= control.high) return {};
  return fail(ErrorCode::value_out_of_range, name + ": the curve has " + base::number_text(rest) +
                                                 " there, outside the range " + range_of(control));
}

/// How near a moved knot may come to the next one, as a part of the domain.
constexpr double kLeastGap = 1e-9;

std::string least_text(double least) {
  return "the least is " + base::number_text(least) + ", " + base::number_text(kLeastGap) +
         " of the domain";
}

/// A knot that stands on another, or nearly so, cannot move between its neighbours.
Result<void> check_alone(const CurveSpec& spec, int knot, double least, const std::string& name) {
  const double here = spec.knots[at(knot)];
  for (const int other : {knot - 1, knot + 1}) {
    const double there = spec.knots[at(other)];
    const double gap = other < knot ? here - there : there - here;
    if (gap >= least) continue;
    std::string text = name + ": the curve has it at " + base::number_text(here) + ", and knot ";
    text += std::to_string(other) + " is at " + base::number_text(there);
    text += gap == 0 ? " too: a repeated knot cannot move"
                     : ", " + base::number_text(gap) + " away; " + least_text(least);
    return fail(ErrorCode::value_out_of_range, std::move(text));
  }
  return {};
}

Result<void> check_knot(const CurveSpec& spec, const std::vector<ControlRange>& controls,
                        const ControlRange& control, const std::string& name) {
  const int outer = spec.periodic ? 0 : spec.degree;
  const int first = outer + 1, last = static_cast<int>(spec.knots.size()) - outer - 2;
  if (control.point < first || control.point > last) {
    return fail(ErrorCode::value_out_of_range,
                name + ": " +
                    (last < first ? "the curve has no inner knots"
                                  : "the inner knots of the curve are " + std::to_string(first) +
                                        ".." + std::to_string(last)));
  }
  double below = spec.knots[at(control.point - 1)], above = spec.knots[at(control.point + 1)];
  for (const ControlRange& other : controls) {
    if (other.kind != Kind::knot) continue;
    if (other.point == control.point - 1) below = std::max(below, other.high);
    if (other.point == control.point + 1) above = std::min(above, other.low);
  }
  const double domain = spec.knots[spec.knots.size() - 1 - at(outer)] - spec.knots[at(outer)];
  const double least = kLeastGap * domain;
  const double gap_below = control.low - below, gap_above = above - control.high;
  if (control.low <= control.high && gap_below >= least && gap_above >= least) {
    return check_rest(spec, control, name);
  }
  if (auto alone = check_alone(spec, control.point, least, name); !alone) return alone;
  if (control.low <= control.high && gap_below > 0 && gap_above > 0) {
    const bool is_below = gap_below < least;
    return fail(ErrorCode::value_out_of_range,
                name + ": its range " + range_of(control) + " comes within " +
                    base::number_text(is_below ? gap_below : gap_above) + " of its neighbour at " +
                    base::number_text(is_below ? below : above) + "; " + least_text(least));
  }
  return fail(ErrorCode::value_out_of_range,
              name + ": its range " + range_of(control) +
                  " does not stay between its neighbours, which come as near as " +
                  base::number_text(below) + " and " + base::number_text(above));
}

Result<void> check_range(const CurveSpec& spec, const ControlRange& control,
                         const std::string& name) {
  const int points = written_points(spec);
  if (control.point < 0 || control.point >= points) {
    return fail(ErrorCode::value_out_of_range,
                name + ": the curve has points 0.." + std::to_string(points - 1));
  }
  const bool weight = control.kind == Kind::weight;
  if (!weight && (control.coordinate < 0 || control.coordinate >= spec.dim)) {
    return fail(ErrorCode::value_out_of_range,
                name + ": the curve has coordinates 0.." + std::to_string(spec.dim - 1));
  }
  const double least = weight ? kMinWeight : -kMaxCoordinate;
  const double most = weight ? kMaxWeight : kMaxCoordinate;
  if (!(control.low >= least && control.high <= most && control.low <= control.high)) {
    return fail(ErrorCode::value_out_of_range, name + ": range " + base::number_text(control.low) +
                                                   ".." + base::number_text(control.high) +
                                                   " is not within " + base::number_text(least) +
                                                   ".." + base::number_text(most));
  }
  return check_rest(spec, control, name);
}

bool in_conflict(const ControlRange& a, const ControlRange& b) {
  if (a.point != b.point) return false;
  if (a.kind == Kind::knot || b.kind == Kind::knot) return a.kind == b.kind;
  if (a.kind == Kind::coordinate && b.kind == Kind::coordinate) return a.coordinate == b.coordinate;
  return true;  // the same weight twice, or w P with both moving
}

}  // namespace

Result<void> check_controls(const NurbsCurve& curve, const std::vector<ControlRange>& controls) {
  if (controls.size() > static_cast<std::size_t>(kMaxControls)) {
    return fail(ErrorCode::value_out_of_range,
                "curve '" + curve.name() + "': " + std::to_string(controls.size()) +
                    " controls, at most " + std::to_string(kMaxControls) + " are allowed");
  }
  const CurveSpec spec = curve.spec();
  for (std::size_t k = 0; k < controls.size(); ++k) {
    const std::string name = name_of(curve, controls[k], k);
    auto checked = controls[k].kind == Kind::knot ? check_knot(spec, controls, controls[k], name)
                                                  : check_range(spec, controls[k], name);
    if (!checked) return checked;
    for (std::size_t other = 0; other < k; ++other) {
      if (!in_conflict(controls[k], controls[other])) continue;
      return fail(ErrorCode::control_conflict,
                  name + " and control " + std::to_string(other) +
                      " move the same number, or a weight and its own point");
    }
  }
  return {};
}

bool moves_knots(const std::vector<ControlRange>& controls) {
  return std::any_of(controls.begin(), controls.end(),
                     [](const ControlRange& control) { return control.kind == Kind::knot; });
}

double rest_value(const CurveSpec& spec, const ControlRange& control) {
  if (control.kind == Kind::knot) return spec.knots[at(control.point)];
  if (control.kind == Kind::coordinate) {
    return spec.points[at(control.point * spec.dim + control.coordinate)];
  }
  return spec.weights.empty() ? 1.0 : spec.weights[at(control.point)];
}

HomogeneousCurve control_term(const NurbsCurve& curve, const ControlRange& control) {
  HomogeneousCurve term(curve);
  const int written = written_points(curve.spec());
  for (int i = 0; i < static_cast<int>(term.points.size()); ++i) {
    HomogeneousPoint& point = term.points[at(i)];
    point.x = {};
    point.w = 0.0;
    if (control.kind == Kind::knot || i % written != control.point)
      continue;  // a periodic curve has its first points twice
    if (control.kind == Kind::coordinate) {
      point.x[at(control.coordinate)] = curve.weights()[at(i)];
      continue;
    }
    point.w = 1.0;
    for (int c = 0; c < curve.dim(); ++c) {
      point.x[at(c)] = curve.points()[at(i * curve.dim() + c)];
    }
  }
  return term;
}

Result<NurbsCurve> curve_with(const NurbsCurve& curve, const std::vector<ControlRange>& controls,
                              const std::vector<double>& values) {
  CurveSpec spec = curve.spec();
  for (std::size_t k = 0; k < controls.size(); ++k) {
    if (controls[k].kind == Kind::knot) {
      spec.knots[at(controls[k].point)] = values[k];
      continue;
    }
    if (controls[k].kind == Kind::coordinate) {
      spec.points[at(controls[k].point * spec.dim + controls[k].coordinate)] = values[k];
      continue;
    }
    if (spec.weights.empty()) spec.weights.assign(at(written_points(spec)), 1.0);
    spec.weights[at(controls[k].point)] = values[k];
  }
  return NurbsCurve::create(std::move(spec));
}

HullRange hull_over(const NurbsCurve& curve, int coordinate,
                    const std::vector<ControlRange>& controls) {
  const CurveSpec spec = curve.spec();
  HullRange hull{kMaxCoordinate, -kMaxCoordinate};
  for (int i = 0; i < written_points(spec); ++i) {
    double low = spec.points[at(i * spec.dim + coordinate)];
    double high = low;
    for (const ControlRange& control : controls) {
      if (control.kind != Kind::coordinate || control.point != i) continue;
      if (control.coordinate != coordinate) continue;
      low = control.low;
      high = control.high;
    }
    hull.low = std::min(hull.low, low);
    hull.high = std::max(hull.high, high);
  }
  return hull;
}

}  // namespace knotwave::curves
