// SPDX-License-Identifier: MIT
// Degree reduction by least squares: the curve sought, cut into the Bézier segments of the curve
// given and raised to its degree, shall have the same Bézier points, each counted relative to its
// weight. For polynomials that is the best reduction in the mean square (Lutterkort, Peters & Reif,
// Polynomial degree reduction in the L2-norm equals best Euclidean approximation of Bézier
// coefficients, CAGD 16 (1999)); an elevated curve misses by no more than its own rounding. (A5.11
// reduces span by span and then removes knots, each step with the noise of the one before.)
#include "degree_reduction.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"
#include "knotwave/curves/reduce.h"

#include "curve_distance.h"
#include "spec_layout.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using base::number_text;

constexpr std::size_t kChannels = kMaxDim + 1;
DoubleDouble& channel(HomogeneousPoint& point, std::size_t c) {
  return c < point.x.size() ? point.x[c] : point.w;
}

// The knots from the start of the domain to before its end, each one time less, simple ones kept.
std::vector<Knot> reduced_knots(const HomogeneousCurve& curve) {
  const int p = curve.degree;
  const auto end = curve.knots.end() - p - 1;  // of the domain
  std::vector<Knot> inner;                     // from the start of the domain on
  for (auto run =
           std::lower_bound(curve.knots.begin(), curve.knots.end(), curve.knots[index_of(p)]);
       run < end && *run < *end;) {
    const auto next = std::upper_bound(run, curve.knots.end(), *run);
    inner.insert(inner.end(), index_of(std::max(1, static_cast<int>(next - run) - 1)), *run);
    run = next;
  }
  return inner;
}

// The lower degree's curve with its knots and no points yet.
HomogeneousCurve reduced_frame(const HomogeneousCurve& curve, const std::vector<Knot>& inner) {
  HomogeneousCurve frame;
  const int p = curve.degree, q = p - 1;
  frame.degree = q;
  frame.dim = curve.dim;
  frame.domain = curve.domain;
  if (!curve.domain.periodic) {
    frame.knots = inner;  // the clamped start has p of its p + 1
    frame.knots.insert(frame.knots.end(), index_of(p), curve.knots[curve.points.size()]);
  } else {
    std::vector<double> written;
    written.reserve(inner.size() + 1);
    for (const Knot& knot : inner) written.push_back(knot.at);
    written.push_back(curve.domain.high);
    const auto all = expanded_knots(written, q, static_cast<int>(inner.size()), true);
    frame.knots = KnotSequence{all, q, true}.all();
  }
  frame.points.resize(frame.knots.size() - index_of(q + 1));
  return frame;
}

// How much of each of the q + 1 points of a span is in each Bézier point of degree q + 1 of it.
std::vector<std::vector<DoubleDouble>> raised_shares(const HomogeneousCurve& frame, int span,
                                                     const BezierPiece& piece) {
  const int q = frame.degree;
  HomogeneousCurve local = frame.points_between(span - q, span);
  std::vector<std::vector<DoubleDouble>> shares(index_of(q + 2));
  std::vector<HomogeneousPoint> raised;
  for (std::size_t j = 0; j < index_of(q + 1); j += kChannels) {  // unit points, 5 at a time
    for (std::size_t k = 0; k < local.points.size(); ++k) {
      for (std::size_t c = 0; c < kChannels; ++c) {
        channel(local.points[k], c) = k == j + c ? 1.0 : 0.0;
      }
    }
    raised.assign(index_of(q + 1), HomogeneousPoint());
    bezier_points(local, q, piece.left, piece.right, raised);
    raise_degree(raised);
    for (std::size_t i = 0; i < raised.size(); ++i) {
      for (std::size_t c = 0; c < kChannels && j + c < index_of(q + 1); ++c) {
        shares[i].push_back(channel(raised[i], c));
      }
    }
  }
  return shares;
}

// Symmetric and positive definite; entries left of a row's first are 0 and stay it (LDL^T).
class Envelope {
 public:
  // Each unknown meets those up to `reach` away, around the end too if `cyclic`.
  Envelope(std::size_t size, std::size_t reach, bool cyclic) : right_(size) {
    for (std::size_t i = 0; i < size; ++i) {
      const bool wraps = cyclic && i + reach >= size;
      first_.push_back(wraps || i < reach ? 0 : i - reach);
      rows_.emplace_back(i - first_.back() + 1);
    }
    for (auto& channels : right_) channels.fill(0.0);
  }
  void add(std::size_t i, std::size_t j, DoubleDouble x) {
    if (j <= i) entry(i, j) += x;
  }
  void add_right(std::size_t i, std::size_t c, DoubleDouble x) { right_[i][c] += x; }

  // The solution, or nothing if a pivot is not positive.
  std::vector<std::array<DoubleDouble, kChannels>> solve() {
    const std::size_t size = rows_.size();
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = first_[i]; j < i; ++j) {  // L D of the row, then L
        DoubleDouble sum = entry(i, j);
        for (std::size_t k = std::max(first_[i], first_[j]); k < j; ++k) {
          sum = sum - entry(i, k) * entry(j, k);
        }
        entry(i, j) = sum;
      }
      for (std::size_t j = first_[i]; j < i; ++j) {
        const DoubleDouble scaled = entry(i, j) / entry(j, j);
        entry(i, i) = entry(i, i) - scaled * entry(i, j);
        entry(i, j) = scaled;
        for (std::size_t c = 0; c < kChannels; ++c) {
          right_[i][c] = right_[i][c] - scaled * right_[j][c];
        }
      }
      if (!(entry(i, i).hi > 0)) return {};
    }
    for (std::size_t i = size; i-- > 0;) {
      for (std::size_t c = 0; c < kChannels; ++c) right_[i][c] = right_[i][c] / entry(i, i);
    }
    for (std::size_t i = size; i-- > 0;) {
      for (std::size_t j = first_[i]; j < i; ++j) {
        for (std::size_t c = 0; c < kChannels; ++c) {
          right_[j][c] = right_[j][c] - entry(i, j) * right_[i][c];
        }
      }
    }
    return right_;
  }

 private:
  DoubleDouble& entry(std::size_t i, std::size_t j) { return rows_[i][j - first_[i]]; }

  std::vector<std::size_t> first_;
  std::vector<std::vector<DoubleDouble>> rows_;
  std::vector<std::array<DoubleDouble, kChannels>> right_;
};

using FixedPoints = std::vector<const HomogeneousPoint*>;  // null where a point is sought

// Points that are not sought: ends of the curve and both sides of jumps.
FixedPoints fixed_points(const HomogeneousCurve& frame, const std::vector<BezierPiece>& pieces) {
  FixedPoints fixed(frame.points.size(), nullptr);
  if (frame.domain.periodic) return fixed;
  const auto is_end = [&frame](Knot knot) { return frame.multiplicity(knot) > frame.degree; };
  for (const BezierPiece& piece : pieces) {
    const int span = frame.span_at(piece.left, Side::right);
    if (is_end(piece.left)) fixed[index_of(span - frame.degree)] = &piece.points.front();
    if (is_end(piece.right)) fixed[index_of(span)] = &piece.points.back();
  }
  return fixed;
}

// The p + 1 equations of one piece, squared.
void add_equations(Envelope& equations, const BezierPiece& piece,
                   const std::vector<std::vector<DoubleDouble>>& shares, const FixedPoints& fixed,
                   std::size_t start, std::size_t count) {
  for (std::size_t i = 0; i < shares.size(); ++i) {
    HomogeneousPoint rest = piece.points[i];
    const DoubleDouble scale = DoubleDouble(1.0) / (rest.w * rest.w);
    for (std::size_t j = 0; j < shares[i].size(); ++j) {
      if (fixed[start + j] == nullptr) continue;
      HomogeneousPoint known = *fixed[start + j];
      for (std::size_t c = 0; c < kChannels; ++c) {
        channel(rest, c) = channel(rest, c) - shares[i][j] * channel(known, c);
      }
    }
    for (std::size_t j = 0; j < shares[i].size(); ++j) {
      if (fixed[start + j] != nullptr) continue;
      const std::size_t row = (start + j) % count;
      const DoubleDouble scaled = shares[i][j] * scale;
      for (std::size_t k = 0; k < shares[i].size(); ++k) {
        if (fixed[start + k] != nullptr) continue;
        equations.add(row, (start + k) % count, scaled * shares[i][k]);
      }
      for (std::size_t c = 0; c < kChannels; ++c) {
        equations.add_right(row, c, scaled * channel(rest, c));
      }
    }
  }
}

// False if there is no solution with positive weights.
bool solve_points(HomogeneousCurve& frame, const std::vector<BezierPiece>& pieces) {
  const bool periodic = frame.domain.periodic;
  const std::size_t q = index_of(frame.degree);
  const std::size_t count = frame.points.size() - (periodic ? q : 0);
  const FixedPoints fixed = fixed_points(frame, pieces);
  Envelope equations(count, q, periodic);
  for (const BezierPiece& piece : pieces) {
    const int span = frame.span_at(piece.left, Side::right);
    add_equations(equations, piece, raised_shares(frame, span, piece), fixed, index_of(span) - q,
                  count);
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (fixed[i] == nullptr) continue;
    HomogeneousPoint known = *fixed[i];
    equations.add(i, i, 1.0);
    for (std::size_t c = 0; c < kChannels; ++c) equations.add_right(i, c, channel(known, c));
  }
  const auto solution = equations.solve();
  if (solution.empty()) return false;
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    for (std::size_t c = 0; c < kChannels; ++c) {
      channel(frame.points[i], c) = solution[i % count][c];
    }
    if (!(frame.points[i].w.hi > 0)) return false;
  }
  return true;
}

Error missed(const NurbsCurve& curve, const std::string& why) {
  return fail(ErrorCode::error_bound_missed, "curve '" + curve.name() + "': at degree " +
                                                 std::to_string(curve.degree() - 1) + " " + why);
}

}  // namespace

Error with_tolerance(Error error, double tolerance) {
  if (error.code == ErrorCode::error_bound_missed) {
    error.message += ", the tolerance is " + number_text(tolerance);
  }
  return error;
}

Result<NurbsCurve> least_squares_reduction(const NurbsCurve& curve) {
  if (curve.degree() == 1) {
    return fail(ErrorCode::degree_out_of_range,
                "curve '" + curve.name() + "': degree 0 is outside 1..15");
  }
  HomogeneousCurve before(curve);
  if (!curve.is_periodic()) before = before.clamped_part(curve.u_min(), curve.u_max());
  const std::vector<Knot> inner = reduced_knots(before);
  if (curve.is_periodic() && static_cast<int>(inner.size()) < curve.degree()) {
    return missed(curve, "a period would have " + std::to_string(inner.size()) +
                             " points and needs " + std::to_string(curve.degree()));
  }
  HomogeneousCurve after = reduced_frame(before, inner);
  if (!solve_points(after, bezier_pieces(before))) {
    return missed(curve, "a weight would not be positive");
  }
  CurveSpec spec;
  spec.name = curve.name();
  spec.degree = after.degree;
  spec.dim = after.dim;
  spec.periodic = curve.is_periodic();
  spec.jumps.assign(curve.jumps().begin(), curve.jumps().end());
  after.write_to(spec);
  auto result = NurbsCurve::create(std::move(spec));
  if (!result) return missed(curve, "there is no curve (" + result.error().message + ")");
  return result;
}

Result<ReducedCurve> reduce_degree(const NurbsCurve& curve, double tolerance) {
  if (!(tolerance >= 0) || !std::isfinite(tolerance)) {
    return fail(ErrorCode::value_out_of_range, "curve '" + curve.name() + "': a tolerance of " +
                                                   number_text(tolerance) +
                                                   " is not a number from 0 up");
  }
  auto result = least_squares_reduction(curve);
  if (!result) return with_tolerance(result.error(), tolerance);
  constexpr double kNoLimit = 1e300;
  const double error = distance_bound(std::span(&curve, 1), std::span(&*result, 1), kNoLimit);
  if (!(error <= tolerance)) {
    return with_tolerance(missed(curve, "it is up to " + number_text(error) + " away"), tolerance);
  }
  return ReducedCurve{std::move(*result), 1, error};
}

}  // namespace knotwave::curves
