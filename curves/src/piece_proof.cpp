// SPDX-License-Identifier: MIT
#include "piece_proof.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grid_kernel.h"
#include "next_double.h"
#include "piece_bounds.h"

namespace knotwave::curves {
namespace {

constexpr int kDegree = kMaxPieceDegree;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::span<const double> row_of(const FitPiece& piece, int output) {
  return piece.coefficients.subspan(at(output * (kDegree + 1)), at(kDegree + 1));
}

/// What playing the piece rounds away, and 1 rounding of the value it is compared with.
double rounding_of(std::span<const double> row, const FitLimits& limits, int output) {
  constexpr double kUnit = 0x1p-53 * (1 + 0x1p-40);
  const double largest =
      std::max(std::abs(limits.low[at(output)]), std::abs(limits.high[at(output)]));
  return kUnit * (rounding_units(row) + largest);
}

double largest_bound(const ErrorForm& form, std::span<const double> row, const FitLimits& limits,
                     int output, double found, double settled) {
  const double rounding = rounding_of(row, limits, output);
  const double most = limits.max_error - rounding;
  if (!(most > 0)) return kInfinity;
  const ErrorLimits to{limits.low[at(output)], limits.high[at(output)], found, settled - rounding,
                       most};
  return error_bound(form, to) + rounding;
}

/// Whether so few doubles lie in a piece that each can be looked at.
bool has_few_doubles(const FitPiece& piece) {
  double u = piece.u_a;
  for (int count = 32; count > 0 && u < piece.u_b; --count) u = next_up(u);
  return u >= piece.u_b;
}

template <class Error>
double worst_of_doubles(const FitPiece& piece, const Error& error_at) {
  double worst = 0;
  for (double u = piece.u_a; u < piece.u_b; u = next_up(u)) worst = std::max(worst, error_at(u));
  return worst;
}

/// One output as it is played.
double played(const FitPiece& piece, double u, const FitLimits& limits, int output) {
  const double place = (u - piece.u_a) * (1.0 / (piece.u_b - piece.u_a));
  return clamp_to_hull(horner(row_of(piece, output).data(), kDegree, place), limits.low[at(output)],
                       limits.high[at(output)]);
}

}  // namespace

DoubleDouble ParameterProof::place_of(double u) const {
  return DoubleDouble::difference(u, span_.u0) / DoubleDouble::difference(span_.u1, span_.u0);
}

double ParameterProof::operator()(const FitPiece& piece, double found, double settled) const {
  if (!has_few_doubles(piece)) return error_over(piece, found, settled);
  return worst_of_doubles(piece, [&](double u) { return error_at(piece, u); });
}

double ParameterProof::error_at(const FitPiece& piece, double u) const {
  const DoubleDouble t = place_of(u);
  const auto weight = span_.bezier_row(span_.dim);
  double worst = 0;
  for (int c = 0; c < span_.dim; ++c) {
    const auto row = span_.bezier_row(c);
    const DoubleDouble y = quotient_at({row.begin(), row.end()}, {weight.begin(), weight.end()}, t);
    worst = std::max(worst, std::abs((y - DoubleDouble(played(piece, u, limits_, c))).hi));
  }
  return worst;
}

double ParameterProof::error_over(const FitPiece& piece, double found, double settled) const {
  const DoubleDouble t0 = place_of(piece.u_a), t1 = place_of(piece.u_b);
  const auto part = [&](int c) {
    const auto row = span_.bezier_row(c);
    return scaled(part_of(Bernstein(row.begin(), row.end()), t0, t1));
  };
  const ScaledBernstein one = scaled_one(kDegree), weight = part(span_.dim);
  ErrorForm form;
  form.weight = convolved(weight, one);
  double worst = 0;
  for (int c = 0; c < span_.dim && worst < kInfinity; ++c) {
    const auto row = row_of(piece, c);
    form.value = convolved(part(c), one);
    form.gap = form.value - convolved(weight, scaled_powers(row));
    worst = std::max(worst, largest_bound(form, row, limits_, c, found, std::max(settled, worst)));
  }
  return worst;
}

TimeProof::TimeProof(const TimedSpan& span, const FitLimits& limits)
    : timed_(span), span_(span.of), limits_(limits), clock_(span) {}

SpanClock::Around TimeProof::between(double early, double late) {
  const SpanClock::Around a = clock_.around(early), b = clock_.around(late);
  return timed_.is_backward ? SpanClock::Around{b.low, a.high} : SpanClock::Around{a.low, b.high};
}

Bernstein TimeProof::part(int c, const SpanClock::Around& t) const {
  const auto row = span_.bezier_row(c);
  if (t.high.hi <= 0) return Bernstein(row.size(), row.front());
  return part_of(Bernstein(row.begin(), row.end()), t.low, t.high);
}

double TimeProof::operator()(const FitPiece& piece, double found, double settled) {
  if (!has_few_doubles(piece)) return error_over(piece, found, settled);
  return worst_of_doubles(piece, [&](double x) { return error_at(piece, x); });
}

double TimeProof::error_over(const FitPiece& piece, double found, double settled) {
  const SpanClock::Around t = between(piece.u_a, piece.u_b);
  const DoubleDouble width = DoubleDouble::difference(piece.u_b, piece.u_a);
  const DoubleDouble start = timed_.local(piece.u_a);
  Bernstein local;  // (X - x_a D) / width, over the whole span
  for (std::size_t j = 0; j < span_.bezier_row(0).size(); ++j) {
    const DoubleDouble since = span_.bezier_row(0)[j] - span_.bezier_row(span_.dim)[j] * start;
    local.push_back((timed_.is_backward ? -since : since) / width);
  }
  const ScaledBernstein place = scaled(part_of(std::move(local), t.low, t.high));
  std::vector<ScaledBernstein> weights{{DoubleDouble(1.0)}};  // powers 0 .. 7 of D
  const ScaledBernstein weight = scaled(part(span_.dim, t));
  for (int k = 0; k < kDegree; ++k) weights.push_back(convolved(weights.back(), weight));
  ErrorForm form;
  form.weight = weights.back();
  double worst = 0;
  for (int c = 0; c + 1 < span_.dim && worst < kInfinity; ++c) {
    const auto row = row_of(piece, c);
    ScaledBernstein sum{DoubleDouble(row[at(kDegree)])};
    for (int k = kDegree - 1; k >= 0; --k) {
      sum = convolved(sum, place);
      const ScaledBernstein& power = weights[at(kDegree - k)];
      for (std::size_t j = 0; j < sum.size(); ++j) sum[j] += power[j] * DoubleDouble(row[at(k)]);
    }
    form.value = convolved(scaled(part(c + 1, t)), weights[at(kDegree - 1)]);
    form.gap = form.value - sum;
    worst = std::max(worst, largest_bound(form, row, limits_, c, found, std::max(settled, worst)));
  }
  return worst;
}

double TimeProof::error_at(const FitPiece& piece, double x) {
  const SpanClock::Around t = clock_.around(x);
  const Bernstein weight = part(span_.dim, t);
  double worst = 0;
  for (int c = 0; c + 1 < span_.dim; ++c) {
    const DoubleDouble y = played(piece, x, limits_, c);
    const Bernstein value = part(c + 1, t);
    for (std::size_t j = 0; j < value.size(); ++j) {
      worst = std::max(worst, std::abs((value[j] / weight[j] - y).hi));
    }
  }
  return worst;
}

double TimeProof::change_over(const SpanClock::Around& t) const {
  const Bernstein weight = part(span_.dim, t);
  double most = 0;
  for (int c = 1; c < span_.dim; ++c) {
    const Bernstein value = part(c, t);
    DoubleDouble low = value[0] / weight[0], high = low;
    for (std::size_t j = 1; j < value.size(); ++j) {
      const DoubleDouble y = value[j] / weight[j];
      if ((y - low).hi < 0) low = y;
      if ((y - high).hi > 0) high = y;
    }
    most = std::max(most, (high - low).hi);
  }
  return most;
}

double TimeProof::change_before(double x) {
  const SpanClock::Around t = clock_.around(x);
  return change_over(timed_.is_backward ? SpanClock::Around{t.low, 1.0}
                                        : SpanClock::Around{0.0, t.high});
}

double TimeProof::change_after(double x) {
  const SpanClock::Around t = clock_.around(x);
  return change_over(timed_.is_backward ? SpanClock::Around{0.0, t.high}
                                        : SpanClock::Around{t.low, 1.0});
}

double TimeProof::change_between(double early, double late) {
  return change_over(between(early, late));
}

}  // namespace knotwave::curves
