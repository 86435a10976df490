// SPDX-License-Identifier: MIT
// As blossoms, with u the knots and b1 = f(u_i, u_i, u_i+1), b2 = f(u_i, u_i+1, u_i+1),
// b0 = f(u_i, u_i, u_i), all blends of neighbours:
//   b1, b2 lie between P_i-2 = f(u_i-1, u_i, u_i+1) and P_i-1 = f(u_i, u_i+1, u_i+2),
//   b0     between b2 of the span before and b1,     b3 is b0 of the span after.
// Loops without a branch, arrays of high and of low parts: compilers turn them into vector code.
#include "cubic_spans.h"

#include <algorithm>

#include "knot_domain.h"

namespace knotwave::curves {
namespace {

/// An array of double-doubles.
struct Array {
  std::vector<double> hi, lo;

  explicit Array(std::size_t n) : hi(n), lo(n) {}
};

/// A pointer to such an array, for loops: what is written through one is read through no other.
struct Out {
  double* __restrict hi;
  double* __restrict lo;

  explicit Out(Array& array) : hi(array.hi.data()), lo(array.lo.data()) {}
  void set(std::size_t i, DoubleDouble x) const {
    hi[i] = x.hi;
    lo[i] = x.lo;
  }
};
struct In {
  const double* hi;
  const double* lo;

  explicit In(const Array& array) : hi(array.hi.data()), lo(array.lo.data()) {}
  DoubleDouble operator[](std::size_t i) const { return {hi[i], lo[i]}; }
};

/// part / whole; 0 where the whole is 0, between knots that are all one.
DoubleDouble share_of(DoubleDouble part, DoubleDouble whole) {
  whole.hi = whole.hi > 0 ? whole.hi : 1.0;
  return part / whole;
}

DoubleDouble between(DoubleDouble a, DoubleDouble b, DoubleDouble share) {
  return a + share * (b - a);
}

/// Three times x, right as DoubleDouble is.
DoubleDouble three_times(DoubleDouble x) { return x + (x + x); }

/// Distances between neighbouring knots, [n + 3].
Array gaps_of(const NurbsCurve& curve) {
  const KnotSequence knots{curve.knots(), 3, curve.is_periodic()};
  const KnotDomain domain = knots.domain();
  const std::size_t count = curve.knots().size() - 1;
  Array gaps(count);
  Knot from = knots[0];
  for (std::size_t i = 0; i < count; ++i) {
    const Knot to = knots[static_cast<int>(i) + 1];
    Out(gaps).set(i, domain.distance(from, to));
    from = to;
  }
  return gaps;
}

/// Where b1, b2 and b0 lie between their two neighbours, for the spans from 2 on.
struct Shares {
  Array b1, b2, b0;
};

Shares shares_of(const Array& gaps, std::size_t end) {
  Shares shares{Array(end), Array(end), Array(end)};
  const In gap(gaps);
  const Out b1(shares.b1), b2(shares.b2), b0(shares.b0);
  for (std::size_t i = 2; i < end; ++i) {
    const DoubleDouble before = gap[i - 1];
    const DoubleDouble two = before + gap[i];
    const DoubleDouble three = two + gap[i + 1];
    b1.set(i, share_of(before, three));
    b2.set(i, share_of(two, three));
    b0.set(i, share_of(before, two));
  }
  return shares;
}

/// b1, b2 and b0 of one coordinate.
void blend_spans(const std::vector<double>& points, const Shares& shares, Array& first,
                 Array& second, Array& start) {
  const std::size_t end = first.hi.size();
  const double* const p = points.data();
  const In share1(shares.b1), share2(shares.b2), share0(shares.b0);
  const Out b1(first), b2(second), b0(start);
  for (std::size_t i = 2; i < end; ++i) {
    const DoubleDouble step = DoubleDouble::difference(p[i - 1], p[i - 2]);
    b1.set(i, DoubleDouble(p[i - 2]) + share1[i] * step);
    b2.set(i, DoubleDouble(p[i - 2]) + share2[i] * step);
  }
  const In left(second), right(first);
  for (std::size_t i = 3; i < end; ++i) b0.set(i, between(left[i - 1], right[i], share0[i]));
}

/// [span * 4 + power], rounded, for the spans 3 .. n-1.
void write_powers(const Array& first, const Array& second, const Array& start,
                  std::vector<double>& powers) {
  const In b0(start), b1(first), b2(second);
  double* __restrict const out = powers.data();
  for (std::size_t i = 3; i + 1 < start.hi.size(); ++i) {
    const DoubleDouble d0 = b1[i] - b0[i];
    const DoubleDouble d1 = b2[i] - b1[i];
    const DoubleDouble d2 = b0[i + 1] - b2[i];
    const DoubleDouble e0 = d1 - d0;
    const DoubleDouble e1 = d2 - d1;
    out[i * 4] = b0[i].hi;
    out[i * 4 + 1] = three_times(d0).hi;
    out[i * 4 + 2] = three_times(e0).hi;
    out[i * 4 + 3] = (e1 - e0).hi;
  }
}

}  // namespace

CubicSpans cubic_spans(const NurbsCurve& curve) {
  const auto knots = curve.knots();
  const auto n = static_cast<std::size_t>(curve.point_count());
  const auto dim = static_cast<std::size_t>(curve.dim());
  const Shares shares = shares_of(gaps_of(curve), n + 1);
  CubicSpans spans;
  std::vector<std::size_t> indices;  // of spans that have a length
  for (std::size_t i = 3; i < n; ++i) {
    if (!(knots[i] < knots[i + 1])) continue;
    spans.breaks.push_back(knots[i]);
    indices.push_back(i);
  }
  spans.breaks.push_back(knots[n]);
  spans.coefficients.resize(indices.size() * dim * 4);

  std::vector<double> points(n);
  Array first(n + 1), second(n + 1), start(n + 1);
  std::vector<double> powers((n + 1) * 4);
  for (std::size_t c = 0; c < dim; ++c) {
    for (std::size_t i = 0; i < n; ++i) points[i] = curve.points()[i * dim + c];
    blend_spans(points, shares, first, second, start);
    write_powers(first, second, start, powers);
    for (std::size_t s = 0; s < indices.size(); ++s) {
      std::copy_n(powers.data() + indices[s] * 4, 4, spans.coefficients.data() + (s * dim + c) * 4);
    }
  }
  return spans;
}

}  // namespace knotwave::curves
