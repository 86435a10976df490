// SPDX-License-Identifier: MIT
#include "compile_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "knotwave/base/document.h"

#include "cubic_spans.h"
#include "live_spline.h"
#include "piece_bounds.h"
#include "piece_fit.h"
#include "piece_proof.h"

namespace knotwave::curves {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Values at one end by control: 1 where a control is the end point's own coordinate.
std::vector<double> end_values(const NurbsCurve& curve, int point,
                               const std::vector<ControlRange>& controls) {
  const auto dim = static_cast<std::size_t>(curve.dim());
  std::vector<double> values((1 + controls.size()) * dim, 0.0);
  for (std::size_t c = 0; c < dim; ++c) values[c] = curve.points()[at(point) * dim + c];
  for (std::size_t k = 0; k < controls.size(); ++k) {
    if (controls[k].kind != ControlRange::Kind::coordinate || controls[k].point != point) continue;
    values[(k + 1) * dim + at(controls[k].coordinate)] = 1.0;
  }
  return values;
}

/// Copies a term's rows into place in each piece. One weight for all points is divided out where
/// pieces have no denominator.
void place_term(ProgramParts& parts, const std::vector<SpanPolynomial>& spans, std::size_t term,
                double weight) {
  for (std::size_t i = 0; i < spans.size(); ++i) {
    double* out =
        parts.coefficients.data() + i * parts.piece_size() + term * parts.rows() * parts.powers();
    for (std::size_t r = 0; r < parts.rows() * parts.powers(); ++r) {
      out[r] = (spans[i].rows[r] / DoubleDouble(weight)).hi;
    }
  }
}

/// Corner `corner` of the box of control ranges: bit k set takes control k to its high end.
std::vector<double> corner_values(const std::vector<ControlRange>& controls, unsigned corner) {
  std::vector<double> values;
  for (std::size_t k = 0; k < controls.size(); ++k) {
    values.push_back((corner >> k & 1U) != 0 ? controls[k].high : controls[k].low);
  }
  return values;
}

/// Whether weights lie so far apart that rounding, which is random, is most of the error: then
/// more looks are taken, and what lies between them is covered by a factor of 2.
bool is_delicate(const CurveProgram& program, const NurbsCurve& curve,
                 const std::vector<ControlRange>& controls) {
  if (!program.is_rational()) return false;
  constexpr double kSteady = 30;
  double low = curve.weights()[0];
  double high = low;
  for (const double w : curve.weights()) {
    low = std::min(low, w);
    high = std::max(high, w);
  }
  for (const ControlRange& control : controls) {
    if (control.kind != ControlRange::Kind::weight) continue;
    low = std::min(low, control.low);
    high = std::max(high, control.high);
  }
  return high > kSteady * low;
}

/// Where a piece is looked at, as t: places that are no simple fractions, then ever nearer to the
/// right end, where sums of powers cancel and a small weight beside large ones shows it.
std::vector<double> looks_of(bool delicate) {
  const int count = delicate ? 16 : 5;
  std::vector<double> looks(at(count));
  for (int i = 0; i < count; ++i) looks[at(i)] = (i + 0.381966) / count;
  const double closer = delicate ? 0x1p-1 : 0x1p-4;
  for (double gap = 0x1p-6; gap > 0x1p-50; gap *= closer) looks.push_back(1 - gap);
  for (int last = 1; delicate && last <= 16; ++last) looks.push_back(1 - last * 0x1p-53);
  return looks;
}

double error_at_corner(const CurveProgram& program, const NurbsCurve& curve,
                       const std::vector<double>& controls, std::span<const double> looks) {
  double worst = 0;
  double exact[kMaxDim];
  const auto breaks = program.breaks();
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    for (const double t : looks) {
      const double u = breaks[i] + t * (breaks[i + 1] - breaks[i]);
      if (!(u < breaks[i + 1])) continue;
      curve.evaluate(u, exact);
      for (int c = 0; c < program.dim(); ++c) {
        const double error = std::abs(program.at_u(u, c, controls) - exact[c]);
        worst = error <= worst ? worst : error;  // NaN counts as worst and stays
      }
    }
  }
  return worst;
}

}  // namespace

ProgramParts frame_of(const NurbsCurve& curve, const std::vector<ControlRange>& controls) {
  ProgramParts parts;
  parts.dim = curve.dim();
  parts.periodic = curve.is_periodic();
  for (int c = 0; c < curve.dim(); ++c) {
    const HullRange hull = hull_over(curve, c, controls);
    parts.low.push_back(hull.low);
    parts.high.push_back(hull.high);
  }
  const CurveSpec spec = curve.spec();
  for (const ControlRange& control : controls) {
    parts.control_rest.push_back(rest_value(spec, control));
    parts.control_low.push_back(control.low);
    parts.control_high.push_back(control.high);
  }
  if (!curve.is_periodic()) {
    if (curve.knots().front() == curve.u_min()) parts.start_values = end_values(curve, 0, controls);
    if (curve.knots().back() == curve.u_max()) {
      parts.end_values = end_values(curve, curve.point_count() - 1, controls);
    }
  }
  return parts;
}

ProgramParts exact_parts(const NurbsCurve& curve, const std::vector<ControlRange>& controls) {
  ProgramParts parts = frame_of(curve, controls);
  if (curve.degree() == 3 && !curve.is_rational() && controls.empty()) {
    CubicSpans spans = cubic_spans(curve);
    parts.degree = 3;
    parts.breaks = std::move(spans.breaks);
    parts.coefficients = std::move(spans.coefficients);
    return parts;
  }
  const auto is_weight = [](const ControlRange& c) { return c.kind == ControlRange::Kind::weight; };
  parts.degree = curve.degree();
  parts.rational = curve.is_rational() || std::any_of(controls.begin(), controls.end(), is_weight);
  const std::vector<SpanPolynomial> spans = span_polynomials(HomogeneousCurve(curve));
  for (const SpanPolynomial& span : spans) parts.breaks.push_back(span.u0);
  parts.breaks.push_back(spans.back().u1);
  parts.coefficients.assign(spans.size() * parts.piece_size(), 0.0);
  const double weight = parts.rational ? 1.0 : curve.weights().front();
  place_term(parts, spans, 0, weight);
  for (std::size_t k = 0; k < controls.size(); ++k) {
    place_term(parts, span_polynomials(control_term(curve, controls[k])), k + 1, weight);
  }
  if (moves_knots(controls)) parts.live = std::make_shared<const LiveSpline>(curve, controls);
  return parts;
}

Result<ProgramParts> fitted_parts(const NurbsCurve& curve, const CompileOptions& options,
                                  Meeting meeting) {
  ProgramParts parts = frame_of(curve, {});
  const FitLimits limits{options.max_error, options.max_pieces, parts.low, parts.high};
  FittedPieces pieces;
  for (const SpanPolynomial& span : span_polynomials(HomogeneousCurve(curve))) {
    const DoubleDouble width = DoubleDouble::difference(span.u1, span.u0);
    const FitTarget target = [&](DoubleDouble u, std::span<DoubleDouble> out) {
      const DoubleDouble t = (u - DoubleDouble(span.u0)) / width;
      for (int c = 0; c < span.dim; ++c) out[at(c)] = coordinate_at(span, c, t);
    };
    const FitTarget slopes = [&](DoubleDouble u, std::span<DoubleDouble> out) {
      const DoubleDouble t = (u - DoubleDouble(span.u0)) / width;
      for (int c = 0; c < span.dim; ++c) out[at(c)] = coordinate_slope_at(span, c, t) / width;
    };
    const ParameterProof proof(span, limits);
    if (!fit_pieces(target, span.u0, span.u1, limits, proof, pieces,
                    meeting == Meeting::slope ? &slopes : nullptr)) {
      return too_many_pieces(curve, options);
    }
  }
  if (!(pieces.max_error <= options.max_error)) {
    return missed_bound(curve, pieces.max_error, options.max_error, "this is rounding");
  }
  pieces.lay_out(parts);
  return parts;
}

double rounding_bound(const ProgramParts& parts) {
  constexpr double kUnit = 0x1p-53 * (1 + 0x1p-40);
  double worst = 0;
  for (std::size_t i = 0; i < parts.pieces(); ++i) {
    const std::span piece = std::span(parts.coefficients).subspan(i * parts.piece_size());
    const auto row = [&](int c) { return piece.subspan(at(c) * parts.powers(), parts.powers()); };
    for (int c = 0; c < parts.dim; ++c) {
      double error = rounding_units(row(c));
      if (parts.rational) {
        // N and D are off by their units, so N / D is by those of N and of D times |N / D|, over
        // the least D there may be; 1 more of the division, 1 of the value it is compared with.
        const double largest = std::max(std::abs(parts.low[at(c)]), std::abs(parts.high[at(c)]));
        const double weight_error = rounding_units(row(parts.dim));
        const PieceRow weights = bernstein_row(row(parts.dim));
        const double least =
            *std::min_element(weights.begin(), weights.begin() + parts.degree + 1) -
            2 * kUnit * weight_error;
        if (!(least > 0)) return std::numeric_limits<double>::infinity();
        error = (error + largest * weight_error) / least + 2 * largest;
      }
      worst = std::max(worst, error);
    }
  }
  return kUnit * worst;
}

Result<double> measured_error(const CurveProgram& program, const NurbsCurve& curve,
                              const std::vector<ControlRange>& controls) {
  constexpr double kBetweenLooks = 4 * 0x1p-52;
  double largest = 0;
  for (int c = 0; c < program.dim(); ++c) {
    largest = std::max({largest, std::abs(program.low(c)), std::abs(program.high(c))});
  }
  const bool delicate = is_delicate(program, curve, controls);
  const std::vector<double> looks = looks_of(delicate);
  double worst = error_at_corner(program, curve, {}, looks);
  for (unsigned corner = 0; !controls.empty() && corner < 1U << controls.size(); ++corner) {
    const std::vector<double> values = corner_values(controls, corner);
    const auto moved = curve_with(curve, controls, values);
    if (!moved) return moved.error();
    const double error = error_at_corner(program, *moved, values, looks);
    worst = error <= worst ? worst : error;
  }
  return 2 * worst + kBetweenLooks * largest;
}

Error missed_bound(const NurbsCurve& curve, double error, double asked, const std::string& why) {
  return fail(ErrorCode::error_bound_missed, "curve '" + curve.name() + "': the program is " +
                                                 base::number_text(error) + " from the curve, " +
                                                 base::number_text(asked) + " was asked: " + why);
}

Error too_many_pieces(const NurbsCurve& curve, const CompileOptions& options) {
  return fail(ErrorCode::error_bound_missed,
              "curve '" + curve.name() + "': " + std::to_string(options.max_pieces) +
                  " pieces are not enough to follow its " + std::to_string(curve.point_count()) +
                  " points of degree " + std::to_string(curve.degree()) + " within " +
                  base::number_text(options.max_error) +
                  ", which was asked; use fewer points or a lower degree");
}

}  // namespace knotwave::curves
