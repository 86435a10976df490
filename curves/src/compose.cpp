// SPDX-License-Identifier: MIT
// outer(inner(u)) span by span: de Casteljau's construction on a segment of the outer curve, with
// the inner curve's polynomials in place of the parameter.
// Source: DeRose, Composing Bézier simplexes, ACM TOG 7 (1988).
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "knotwave/base/document.h"
#include "knotwave/base/index.h"
#include "knotwave/curves/combine.h"

#include "bernstein.h"
#include "curve_chain.h"
#include "curve_distance.h"

namespace knotwave::curves {
namespace {

using base::index_of;
using base::number_text;

// (a f + b g) / over
Bernstein mixed(DoubleDouble a, const Bernstein& f, DoubleDouble b, const Bernstein& g,
                DoubleDouble over) {
  Bernstein result(f.size());
  for (std::size_t i = 0; i < f.size(); ++i) result[i] = (a * f[i] + b * g[i]) / over;
  return result;
}

// A span of the inner curve, x over w.
struct InnerPiece {
  double u0 = 0, u1 = 1;
  Bernstein x, w;

  double value_at_middle() const {
    InnerPiece left = *this;
    left.cut(0.5 * u0 + 0.5 * u1);
    return (left.x.back() / left.w.back()).hi;
  }
  // de Casteljau at u: this becomes the part before u, the part after it is returned.
  InnerPiece cut(double u) {
    InnerPiece after = *this;
    const DoubleDouble before_u = DoubleDouble::difference(u, u0);
    const DoubleDouble after_u = DoubleDouble::difference(u1, u);
    for (Bernstein InnerPiece::*of : {&InnerPiece::x, &InnerPiece::w}) {
      Bernstein &left = this->*of, &right = after.*of;
      for (std::size_t level = 1; level < left.size(); ++level) {
        for (std::size_t r = 0; r + level < left.size(); ++r) {
          right[r] = (after_u * right[r] + before_u * right[r + 1]) / (before_u + after_u);
        }
        left[level] = right[0];
      }
    }
    u1 = after.u0 = u;
    return after;
  }
};

// Where a piece goes through the value k: u to the nearest double.
struct Crossing {
  double u = 0;
  double k = 0;
};

// -1, 0 or 1: on which side of k coefficient i is. What is left of 106 bits by rounding counts as
// 0, else a stretch at k itself would seem to cross it everywhere.
int side_of(const InnerPiece& piece, std::size_t i, double k) {
  const DoubleDouble at_k = DoubleDouble(k) * piece.w[i];
  const double above = (piece.x[i] - at_k).hi;
  const double noise = 0x1p-90 * (std::abs(piece.x[i].hi) + std::abs(at_k.hi));
  return above > noise ? 1 : above < -noise ? -1 : 0;
}

int sign_changes(const InnerPiece& piece, double k) {
  int changes = 0, before = 0;
  for (std::size_t i = 0; i < piece.x.size(); ++i) {
    const int now = side_of(piece, i, k);
    if (now * before < 0) ++changes;
    if (now != 0) before = now;
  }
  return changes;
}

// By halves until no sign changes among the Bernstein coefficients, of which there are at least as
// many as crossings. A touch is none.
void find_crossings(InnerPiece piece, double k, std::vector<Crossing>& found) {
  if (sign_changes(piece, k) == 0) return;
  const double middle = 0.5 * piece.u0 + 0.5 * piece.u1;
  if (!(piece.u0 < middle && middle < piece.u1)) {
    // Neighbouring doubles: a crossing if the ends are on different sides, at the nearer one.
    const DoubleDouble start = piece.x.front() - DoubleDouble(k) * piece.w.front();
    const DoubleDouble end = piece.x.back() - DoubleDouble(k) * piece.w.back();
    if ((start.hi < 0) == (end.hi < 0)) return;
    found.push_back({std::abs(start.hi) < std::abs(end.hi) ? piece.u0 : piece.u1, k});
    return;
  }
  const InnerPiece after = piece.cut(middle);
  const bool at_middle = side_of(piece, piece.x.size() - 1, k) == 0;
  find_crossings(std::move(piece), k, found);
  if (at_middle) found.push_back({middle, k});
  find_crossings(after, k, found);
}

// A place where the piece is above `most` or below `least`, if there is one.
std::optional<double> place_outside(InnerPiece piece, double least, double most) {
  const auto beyond = [&](std::size_t i) {
    return (piece.x[i] - DoubleDouble(most) * piece.w[i]).hi > 0 ||
           (piece.x[i] - DoubleDouble(least) * piece.w[i]).hi < 0;
  };
  const std::size_t last = piece.x.size() - 1;
  if (beyond(0)) return piece.u0;
  if (beyond(last)) return piece.u1;
  bool possible = false;
  for (std::size_t i = 1; i < last; ++i) possible = possible || beyond(i);
  const double middle = 0.5 * piece.u0 + 0.5 * piece.u1;
  if (!possible || !(piece.u0 < middle && middle < piece.u1)) return std::nullopt;
  InnerPiece after = piece.cut(middle);
  if (auto found = place_outside(std::move(piece), least, most)) return found;
  return place_outside(std::move(after), least, most);
}

// The outer curve's segments and which of their joints are jumps.
struct Outer {
  const NurbsCurve& curve;
  std::vector<BezierPiece> pieces;
  std::vector<double> starts;  // of the pieces

  explicit Outer(const NurbsCurve& outer)
      : curve(outer), pieces(bezier_pieces(HomogeneousCurve(outer))) {
    for (const BezierPiece& piece : pieces) starts.push_back(piece.left.at);
  }
  std::size_t piece_at(double value) const {
    const auto above = std::upper_bound(starts.begin() + 1, starts.end(), value);
    return static_cast<std::size_t>(above - starts.begin()) - 1;
  }
  double end_of(std::size_t piece) const {
    return piece + 1 < starts.size() ? starts[piece + 1] : curve.u_max();
  }
  bool has_jump_between(std::size_t a, std::size_t b) const {
    const double low = starts[std::min(a, b)], high = starts[std::max(a, b)];
    return std::any_of(curve.jumps().begin(), curve.jumps().end(),
                       [=](double u) { return u > low && u <= high; });
  }
};

// nullopt where a weight would not be positive.
std::optional<CurvePart> composed(const Outer& outer, std::size_t index, const InnerPiece& inner) {
  const double low = outer.starts[index], high = outer.end_of(index);
  const DoubleDouble width = DoubleDouble::difference(high, low);
  const Bernstein up = mixed(1.0, inner.x, -DoubleDouble(low), inner.w, width);
  const Bernstein down = mixed(high, inner.w, -1.0, inner.x, width);
  const std::vector<HomogeneousPoint>& points = outer.pieces[index].points;
  const int dim = outer.curve.dim();
  CurvePart part;
  for (int c = 0; c <= dim; ++c) {
    std::vector<Bernstein> work;
    work.reserve(points.size());
    for (const HomogeneousPoint& point : points) {
      work.push_back({c < dim ? point.x[index_of(c)] : point.w});
    }
    for (; work.size() > 1; work.pop_back()) {
      for (std::size_t i = 0; i + 1 < work.size(); ++i) {
        work[i] = mixed(1.0, down * work[i], 1.0, up * work[i + 1], 1.0);
      }
    }
    part.points.resize(work[0].size());
    for (std::size_t i = 0; i < work[0].size(); ++i) {
      if (c < dim) part.points[i].x[index_of(c)] = work[0][i];
      if (c == dim) part.points[i].w = work[0][i];
      if (c == dim && !(work[0][i].hi > 0)) return std::nullopt;
    }
  }
  part.knots.assign(part.points.size(), inner.u0);
  part.knots.insert(part.knots.end(), part.points.size(), inner.u1);
  return part;
}

class Composition {
 public:
  Composition(const NurbsCurve& outer, const NurbsCurve& inner)
      : outer_(outer), inner_(inner), chain_(outer.degree() * inner.degree(), outer.dim()) {}

  Result<void> add_span(InnerPiece span) {
    std::vector<Crossing> cuts;
    for (std::size_t i = 1; i < outer_.starts.size(); ++i) {
      find_crossings(span, outer_.starts[i], cuts);
    }
    std::sort(cuts.begin(), cuts.end(),
              [](const Crossing& a, const Crossing& b) { return a.u < b.u; });
    for (const Crossing& cut : cuts) {
      if (!(cut.u > span.u0 && cut.u < span.u1)) continue;
      InnerPiece after = span.cut(cut.u);
      span.x.back() = after.x.front() =
          DoubleDouble(cut.k) * after.w.front();  // what rounding took
      if (auto good = add(std::move(span), 0); !good) return good;
      span = std::move(after);
    }
    return add(std::move(span), 0);
  }

  Result<NurbsCurve> finish() const { return chain_.finish(outer_.curve.name()); }

 private:
  Result<void> add(InnerPiece piece, int halvings) {
    const std::size_t index = outer_.piece_at(piece.value_at_middle());
    const auto part = composed(outer_, index, piece);
    if (!part) {
      constexpr int kMostHalvings = 12;
      if (halvings == kMostHalvings) {
        return fail(ErrorCode::weight_out_of_range,
                    "curve '" + outer_.curve.name() + "' of curve '" + inner_.name() +
                        "': from u = " + number_text(piece.u0) + " to " + number_text(piece.u1) +
                        " a weight would not be positive");
      }
      InnerPiece after = piece.cut(0.5 * piece.u0 + 0.5 * piece.u1);
      if (auto good = add(std::move(piece), halvings + 1); !good) return good;
      return add(std::move(after), halvings + 1);
    }
    const bool may_jump =
        std::find(inner_.jumps().begin(), inner_.jumps().end(), piece.u0) != inner_.jumps().end() ||
        outer_.has_jump_between(index, last_index_);
    chain_.append(*part, may_jump ? 0 : std::numeric_limits<double>::infinity());
    last_index_ = index;
    return {};
  }

  Outer outer_;
  const NurbsCurve& inner_;
  CurveChain chain_;
  std::size_t last_index_ = 0;  // of the outer piece before
};

std::vector<InnerPiece> pieces_of(const NurbsCurve& inner) {
  const HomogeneousCurve all(inner);
  std::vector<InnerPiece> pieces;
  for (const BezierPiece& bezier : bezier_pieces(all)) {
    InnerPiece piece{bezier.left.at, all.domain.rounded(bezier.right), {}, {}};
    for (const HomogeneousPoint& point : bezier.points) {
      piece.x.push_back(point.x[0]);
      piece.w.push_back(point.w);
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

}  // namespace

Result<NurbsCurve> compose(const NurbsCurve& outer, const NurbsCurve& inner) {
  const std::string what = "curve '" + outer.name() + "' of curve '" + inner.name() + "': ";
  if (inner.dim() != 1) {
    return fail(ErrorCode::not_scalar, what + "the inner one has " + std::to_string(inner.dim()) +
                                           " coordinates, expected 1");
  }
  const int degree = outer.degree() * inner.degree();
  if (degree > kMaxDegree) {
    return fail(ErrorCode::degree_out_of_range, what + "degree " + std::to_string(degree) +
                                                    " is outside 1.." + std::to_string(kMaxDegree));
  }
  const std::vector<InnerPiece> pieces = pieces_of(inner);
  const HullRange hull = hull_range(inner);
  const double slack = 0x1p-50 * std::max(std::abs(hull.low), std::abs(hull.high));
  for (const InnerPiece& piece : pieces) {
    const auto u = place_outside(piece, outer.u_min() - slack, outer.u_max() + slack);
    if (!u) continue;
    double value = 0;
    inner.evaluate(*u, *u == piece.u1 ? Side::left : Side::right, std::span(&value, 1));
    return fail(ErrorCode::parameter_out_of_range,
                what + "the inner one is " + number_text(value) + " at u = " + number_text(*u) +
                    ", outside of the outer one's domain " + number_text(outer.u_min()) + ".." +
                    number_text(outer.u_max()));
  }
  Composition composition(outer, inner);
  for (const InnerPiece& piece : pieces) {
    if (auto good = composition.add_span(piece); !good) return good.error();
  }
  return composition.finish();
}

}  // namespace knotwave::curves
