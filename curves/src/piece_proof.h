// SPDX-License-Identifier: MIT
// Bounds on the error of fitted pieces of one span, for fit_pieces(). Private to curves. [control]
#pragma once
#include "error_form.h"
#include "piece_fit.h"
#include "span_clock.h"
#include "span_polynomial.h"

namespace knotwave::curves {

/// Pieces by the span's own parameter: N - P D, of degree p + 7, is what a piece P is off by times
/// D. Where only few doubles are in a piece, each is looked at instead: that is all there is.
class ParameterProof {
 public:
  ParameterProof(const SpanPolynomial& span, const FitLimits& limits)
      : span_(span), limits_(limits) {}
  double operator()(const FitPiece& piece, double found, double settled) const;

 private:
  double error_over(const FitPiece& piece, double found, double settled) const;
  double error_at(const FitPiece& piece, double u) const;
  /// Where u is in the span, from 0 to 1.
  DoubleDouble place_of(double u) const;

  const SpanPolynomial& span_;
  const FitLimits& limits_;
};

/// Pieces of coordinates 1.. by coordinate 0, time, which never goes back: with N and D of a
/// coordinate and X of time, N D^6 - (q_0 D^7 + q_1 S D^6 + ... + q_7 S^7), S = (X - x_a D) /
/// width, of degree 7 p, is what a piece q is off by times D^7, on the interval of the span's
/// parameter where time is in [x_a, x_b]. Few doubles as above.
class TimeProof {
 public:
  TimeProof(const TimedSpan& span, const FitLimits& limits);
  double operator()(const FitPiece& piece, double found, double settled);
  /// How far the outputs may move from the span's first time to x, and from there to its last.
  double change_before(double x);
  double change_after(double x);
  /// How far they may move while nobody knows whether time is before `early` or after `late`.
  double change_between(double early, double late);
  /// How far they move at most in an interval of t.
  double change_over(const SpanClock::Around& t) const;

 private:
  /// Coordinate c (row dim: the weight) over [t.low, t.high].
  Bernstein part(int c, const SpanClock::Around& t) const;
  double error_over(const FitPiece& piece, double found, double settled);
  double error_at(const FitPiece& piece, double x);
  /// The interval of t that holds both, whichever comes first.
  SpanClock::Around between(double early, double late);

  const TimedSpan& timed_;
  const SpanPolynomial& span_;
  const FitLimits& limits_;
  SpanClock clock_;
};

}  // namespace knotwave::curves
