// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/curves/bezier.h"
#include "knotwave/curves/monotone.h"

#include "double_double.h"

namespace knotwave::curves {
namespace {

using base::number_text;

/// A sum of doubles without rounding, smallest parts first (Shewchuk's expansions).
class ExactSum {
 public:
  void add(double term) noexcept {
    for (int i = 0; i < count_; ++i) {
      const DoubleDouble both = DoubleDouble::sum(term, parts_[i]);
      term = both.hi;
      parts_[i] = both.lo;
    }
    parts_[count_++] = term;
  }
  void add(DoubleDouble term) noexcept {
    add(term.lo);
    add(term.hi);
  }
  /// The largest part that is not 0 decides.
  bool is_positive() const noexcept {
    for (int i = count_; i-- > 0;) {
      if (parts_[i] != 0) return parts_[i] > 0;
    }
    return false;
  }

 private:
  double parts_[12] = {};
  int count_ = 0;
};

constexpr double kLongest = 4.0 / 3;  // of a handle; this double is below 4/3
constexpr double kLongestOther = 1.0 / 3;

// The lengths of b that go with a on the ellipse: (2 - a +- sqrt(a (4 - 3 a))) / 2. Their product
// is (1 - a)^2.
double longest_beside(double a) noexcept {
  const DoubleDouble under = DoubleDouble(a) * (DoubleDouble(4) - DoubleDouble::product(3, a));
  return 0.5 * ((2 - a) + std::sqrt(std::max(0.0, under.hi)));
}
double shortest_beside(double a) noexcept { return (1 - a) * (1 - a) / longest_beside(a); }

// Rounding leaves lengths beside the ellipse: a few ulp further they are on the right side of it.
constexpr double kShorter = 1 - 0x1p-53, kLonger = 1 + 0x1p-52;
void step_inside(HandleLengths& lengths, double factor_a, double factor_b) noexcept {
  constexpr int kMostSteps = 16;
  for (int i = 0; i < kMostSteps && !is_monotone_cubic(lengths.a, lengths.b); ++i) {
    lengths.a *= factor_a;
    lengths.b *= factor_b;
  }
}

HandleLengths keep_start(HandleLengths lengths) noexcept {
  if (lengths.a > kLongest) return {kLongest, kLongestOther};
  const bool below = lengths.b < 0.5 * (2 - lengths.a);  // the middle between both lengths
  lengths.b = below ? shortest_beside(lengths.a) : longest_beside(lengths.a);
  step_inside(lengths, 1, below ? kLonger : kShorter);
  return lengths;
}

HandleLengths keep_ratio(HandleLengths lengths) noexcept {
  // Seen from the larger one, so that squares neither overflow nor vanish.
  const double larger = std::max(lengths.a, lengths.b);
  const double a = lengths.a / larger, b = lengths.b / larger;
  const double factor = ((a + b) + std::sqrt(a * b)) / (a * a + a * b + b * b);
  lengths = {a * factor, b * factor};
  step_inside(lengths, kShorter, kShorter);
  return lengths;
}

// Of the active handle (a) and the other one (b).
HandleLengths limit_active(HandleLengths lengths) noexcept {
  lengths.b = std::min(lengths.b, kLongest);
  HandleLengths shorter{std::min(lengths.a, longest_beside(lengths.b)), lengths.b};
  step_inside(shorter, kShorter, 1);
  if (is_monotone_cubic(shorter.a, shorter.b)) return shorter;
  // The other handle is longer than the segment, and this one too short to hold it.
  shorter = {lengths.a, longest_beside(lengths.a)};
  step_inside(shorter, 1, kShorter);
  return shorter;
}

HandleLengths limit_opposite(HandleLengths lengths) noexcept {
  if (lengths.a > kLongest && lengths.b >= kLongestOther) return {kLongest, kLongestOther};
  if (lengths.a <= kLongest) {
    HandleLengths shorter{lengths.a, std::min(lengths.b, longest_beside(lengths.a))};
    step_inside(shorter, 1, kShorter);
    if (is_monotone_cubic(shorter.a, shorter.b)) return shorter;
  }
  // The other handle would have to grow: the active one stops instead.
  lengths.a = longest_beside(lengths.b);
  step_inside(lengths, kShorter, 1);
  return lengths;
}

HandleLengths swapped(HandleLengths lengths) noexcept { return {lengths.b, lengths.a}; }

/// One segment's points P0..P3, [x, y] each.
struct Cubic {
  std::span<double> p;

  double& x(int i) const { return p[static_cast<std::size_t>(2 * i)]; }
  DoubleDouble step(int i) const { return DoubleDouble::difference(x(i + 1), x(i)); }

  /// By the Bernstein coefficients of x', right to 2^-100 of their products.
  bool is_monotone() const {
    const DoubleDouble first = step(0), middle = step(1), last = step(2);
    if (first.hi < 0 || last.hi < 0) return false;
    return middle.hi >= 0 || (middle * middle - first * last).hi <= 0;
  }
  HandleLengths handles() const {
    const double length = x(3) - x(0);
    return {step(0).hi / length, step(2).hi / length};
  }
  /// Handle `inner` (1 or 2), which hangs at `end`, at `factor` of its length.
  void scale_handle(int inner, int end, double factor) const {
    if (factor == 1) return;  // to the bit
    for (int c = 0; c < 2; ++c) {
      double& at = p[static_cast<std::size_t>(2 * inner + c)];
      const double from = p[static_cast<std::size_t>(2 * end + c)];
      at = from + (at - from) * factor;
    }
  }
};

double factor_of(double after, double before) { return before > 0 ? after / before : 0; }

void repair(const Cubic& cubic, Regularization mode) {
  HandleLengths factors;  // a segment of no length: none
  if (cubic.x(0) < cubic.x(3)) {
    const HandleLengths drawn = cubic.handles(), kept = regularize_handles(drawn, mode);
    factors = {factor_of(kept.a, drawn.a), factor_of(kept.b, drawn.b)};
  }
  cubic.scale_handle(1, 0, factors.a);
  cubic.scale_handle(2, 3, factors.b);
  if (mode == Regularization::contain) {  // not by rounding either
    cubic.x(1) = std::min(cubic.x(1), cubic.x(3));
    cubic.x(2) = std::max(cubic.x(2), cubic.x(0));
  }
  // Points are rounded, by up to an ulp of the largest x.
  double give = 0x1p-52;
  while (!cubic.is_monotone()) {
    cubic.scale_handle(1, 0, 1 - give);
    cubic.scale_handle(2, 3, 1 - give);
    give = std::min(1.0, 2 * give);  // 1 leaves no handle: that is monotone
  }
}

bool exceeds(const Cubic& cubic) { return cubic.x(1) > cubic.x(3) || cubic.x(2) < cubic.x(0); }

Result<void> check(const NurbsCurve& curve, const std::string& what) {
  if (curve.degree() != 3 || curve.is_rational()) {
    return fail(ErrorCode::unsupported, what + " has degree " + std::to_string(curve.degree()) +
                                            (curve.is_rational() ? " and weights" : "") +
                                            ", handles are repaired for degree 3 without weights");
  }
  if (curve.dim() != 2) {
    return fail(ErrorCode::dimension_mismatch, what + " has " + std::to_string(curve.dim()) +
                                                   " coordinates, expected 2 (time and value)");
  }
  return {};
}

// Ends that meet are one point, though rounding may have told them apart.
void join(const BezierSegment& left, BezierSegment& right, double near) {
  const double* end = left.points.data() + 6;
  double* begin = right.points.data();
  if (std::abs(end[0] - begin[0]) <= near && std::abs(end[1] - begin[1]) <= near) {
    std::copy_n(end, 2, begin);
  }
}

double largest_coordinate(const NurbsCurve& curve) {
  double largest = 0;
  for (const double x : curve.points()) largest = std::max(largest, std::abs(x));
  return largest;
}

Error goes_back(const std::string& what, const BezierSegment& at, double from, double to) {
  return fail(ErrorCode::not_a_function,
              what + ": time goes back from " + number_text(from) + " to " + number_text(to) +
                  " between u = " + number_text(at.u0) + " and " + number_text(at.u1));
}

}  // namespace

bool is_monotone_cubic(double a, double b) noexcept {
  if (!(a >= 0 && b >= 0)) return false;
  if (a <= 1 && b <= 1) return true;
  if (a > 1.5 || b > 1.5) return false;
  // A length below 2^-300 only matters by not being 0: the other one is 1 or at least 2^-53 off,
  // and the sum below is (1 - b)^2 - a (2 - b) + a^2. Raised, its products don't underflow.
  if (a > 0) a = std::max(a, 0x1p-300);
  if (b > 0) b = std::max(b, 0x1p-300);
  ExactSum sum;
  sum.add(1);
  sum.add(-2 * a);
  sum.add(-2 * b);
  sum.add(DoubleDouble::product(a, b));
  sum.add(DoubleDouble::product(a, a));
  sum.add(DoubleDouble::product(b, b));
  return !sum.is_positive();
}

HandleLengths regularize_handles(HandleLengths lengths, Regularization mode,
                                 bool active_is_start) noexcept {
  if (mode == Regularization::none) return lengths;
  static constexpr double kFinite = 1e300;
  const auto length = [](double x) { return x > 0 ? std::min(x, kFinite) : 0.0; };  // not NaN
  lengths = {length(lengths.a), length(lengths.b)};
  if (mode == Regularization::contain) return {std::min(lengths.a, 1.0), std::min(lengths.b, 1.0)};
  if (is_monotone_cubic(lengths.a, lengths.b)) return lengths;
  if (mode == Regularization::keep_start) return keep_start(lengths);
  if (mode == Regularization::keep_ratio) return keep_ratio(lengths);
  const auto limit = mode == Regularization::limit_active ? limit_active : limit_opposite;
  return active_is_start ? limit(lengths) : swapped(limit(swapped(lengths)));
}

Result<NurbsCurve> regularize(const NurbsCurve& curve, Regularization mode) {
  const std::string what = "curve '" + curve.name() + "'";
  if (auto fits = check(curve, what); !fits) return fits.error();
  std::vector<BezierSegment> segments = to_bezier(curve);
  bool changed = false;
  const double near = 0x1p-50 * largest_coordinate(curve);  // 4 ulp, or more
  double before = segments.front().points[0];
  for (std::size_t i = 0; i < segments.size(); ++i) {
    BezierSegment& segment = segments[i];
    if (i > 0) join(segments[i - 1], segment, near);
    const Cubic cubic{segment.points};
    if (cubic.x(0) < before) return goes_back(what, segment, before, cubic.x(0));
    before = cubic.x(3);
    if (before < cubic.x(0)) return goes_back(what, segment, cubic.x(0), before);
    const bool monotone = cubic.is_monotone();
    if (!monotone && mode == Regularization::none) {
      return goes_back(what, segment, cubic.x(1), cubic.x(2));
    }
    if (monotone && !(mode == Regularization::contain && exceeds(cubic))) continue;
    repair(cubic, mode);
    changed = true;
  }
  if (!changed) return curve;
  auto repaired = from_bezier(segments);
  if (!repaired) return repaired;
  CurveSpec spec = repaired->spec();
  spec.name = curve.name();
  return NurbsCurve::create(std::move(spec));
}

}  // namespace knotwave::curves
