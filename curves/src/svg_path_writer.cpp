// SPDX-License-Identifier: MIT
// A curve to path data.
#include <algorithm>
#include <cmath>

#include "knotwave/base/document.h"
#include "knotwave/curves/svg_path.h"

#include "curve_distance.h"
#include "length.h"

namespace knotwave::curves {
namespace {

using Points = std::vector<HomogeneousPoint>;

// An upper bound of |A / v - b| for a rational piece and a polynomial one: the Bernstein
// coefficients of A - v b, over the least weight. As tight as the two are near.
double distance_from_polynomial(const Points& piece, const Points& near, int dim) {
  const auto row = [](std::size_t n) {  // of Pascal's triangle
    std::vector<double> numbers{1};
    for (std::size_t k = 0; k < n; ++k) {
      numbers.push_back(numbers.back() * static_cast<double>(n - k) / static_cast<double>(k + 1));
    }
    return numbers;
  };
  const std::size_t p = piece.size() - 1, q = near.size() - 1;
  const auto of_piece = row(p), of_near = row(q), of_both = row(p + q);
  double least = piece.front().w.hi, largest = 0;
  for (const HomogeneousPoint& point : piece) least = std::min(least, point.w.hi);
  for (std::size_t k = 0; k <= p + q; ++k) {
    double apart[kMaxDim];
    for (std::size_t c = 0; c < static_cast<std::size_t>(dim); ++c) {
      DoubleDouble sum = 0.0;
      for (std::size_t j = k > q ? k - q : 0; j <= std::min(p, k); ++j) {
        const DoubleDouble off = piece[j].x[c] - piece[j].w * near[k - j].x[c];
        sum += DoubleDouble(of_piece[j] * of_near[k - j]) * off;
      }
      apart[c] = (sum / DoubleDouble(of_both[k])).hi;
    }
    largest = std::max(largest, length_of({apart, static_cast<std::size_t>(dim)}));
  }
  return largest / least;
}

class PathWriter {
 public:
  PathWriter(const NurbsCurve& curve, double max_error, SvgY y)
      : curve_(curve), exact_(curve), max_error_(max_error), y_(y) {}
  Result<SvgPath> write();

 private:
  Result<void> write_piece(const BezierPiece& piece, int halvings);
  bool write_line_or_cubic(const BezierPiece& piece);
  Points cubic_near(const Points& points) const;
  std::string text(double u, const HomogeneousPoint& point) const;
  double number_of(Knot knot) const { return exact_.domain.rounded(knot); }

  const NurbsCurve& curve_;
  HomogeneousCurve exact_;
  double max_error_;
  SvgY y_;
  HomogeneousPoint end_;  // of what was written
  int pieces_ = 0;
  SvgPath path_;
};

HomogeneousPoint rounded(const HomogeneousPoint& point, int dim) {
  double x[kMaxDim];
  const auto used = std::span(x).first(static_cast<std::size_t>(dim));
  point.project(used);
  return {used, 1.0};
}

// The same piece if it is a polynomial of degree <= 3, else the cubic with its ends and slopes.
Points PathWriter::cubic_near(const Points& points) const {
  Points near = points;
  if (!curve_.is_rational() && points.size() <= 4) {
    for (HomogeneousPoint& point : near) {
      for (DoubleDouble& x : point.x) x = x / point.w;
      point.w = 1.0;
    }
    while (near.size() > 2 && near.size() < 4) raise_degree(near);
  } else {
    const double third = static_cast<double>(points.size() - 1) / 3;
    const auto handle = [&](const HomogeneousPoint& end, const HomogeneousPoint& next) {
      HomogeneousPoint at;
      const DoubleDouble pull = next.w / end.w * DoubleDouble(third);
      for (std::size_t c = 0; c < at.x.size(); ++c) {
        const DoubleDouble from = end.x[c] / end.w;
        at.x[c] = from + pull * (next.x[c] / next.w - from);
      }
      return at;
    };
    near = {points.front(), handle(points.front(), points[1]),
            handle(points.back(), points[points.size() - 2]), points.back()};
  }
  for (HomogeneousPoint& point : near) point = rounded(point, curve_.dim());
  near.front() = end_;
  return near;
}

std::string PathWriter::text(double u, const HomogeneousPoint& point) const {
  const bool graph = curve_.dim() == 1;
  const double x = graph ? u : point.x[0].hi, y = point.x[graph ? 0 : 1].hi;
  return base::number_text(x + 0.0) + "," + base::number_text((y_ == SvgY::up ? -y : y) + 0.0);
}

bool PathWriter::write_line_or_cubic(const BezierPiece& piece) {
  const Points near = cubic_near(piece.points);
  const double bound = distance_from_polynomial(piece.points, near, curve_.dim());
  // A graph's u is rounded, too.
  const double from = number_of(piece.left), to = number_of(piece.right);
  const double rounding = curve_.dim() == 1 ? std::max(std::abs(from), std::abs(to)) * 0x1p-51 : 0;
  if (!(bound + rounding <= max_error_)) return false;
  path_.max_error = std::max(path_.max_error, bound + rounding);
  path_.d += near.size() == 2 ? " L" : " C";
  for (std::size_t i = 1; i < near.size(); ++i) {
    const bool last = i + 1 == near.size();
    path_.d += " " + text(last ? to : from + (to - from) * static_cast<double>(i) / 3, near[i]);
  }
  end_ = near.back();
  return true;
}

Result<void> PathWriter::write_piece(const BezierPiece& piece, int halvings) {
  constexpr int kMostHalvings = 16;
  constexpr int kMostPieces = 4096;
  if (pieces_ < kMostPieces && write_line_or_cubic(piece)) {
    ++pieces_;
    return {};
  }
  const double from = number_of(piece.left), to = number_of(piece.right);
  const double half = from + (to - from) / 2;
  if (halvings == kMostHalvings || pieces_ == kMostPieces || !(half > from && half < to)) {
    return fail(ErrorCode::error_bound_missed,
                "curve '" + curve_.name() + "': no path within " + base::number_text(max_error_) +
                    " of it near u = " + base::number_text(from) + " (" + std::to_string(pieces_) +
                    " pieces, halved " + std::to_string(halvings) + " times)");
  }
  const Knot middle{piece.left.period, half};
  auto first = write_piece(piece_between(exact_, piece.left, middle), halvings + 1);
  return first ? write_piece(piece_between(exact_, middle, piece.right), halvings + 1) : first;
}

Result<SvgPath> PathWriter::write() {
  HomogeneousPoint start;
  bool whole = true;
  for (const BezierPiece& piece : bezier_pieces(exact_)) {
    const double u = number_of(piece.left);
    const auto jumps = curve_.jumps();
    const bool jump = std::find(jumps.begin(), jumps.end(), u) != jumps.end();
    if (path_.d.empty() || jump) {
      whole = path_.d.empty();
      start = end_ = rounded(piece.points.front(), curve_.dim());
      path_.d += (whole ? "M " : " M ") + text(u, start);
    }
    if (auto good = write_piece(piece, 0); !good) return good.error();
  }
  const bool closed =
      whole && curve_.dim() == 2 && start.x[0].hi == end_.x[0].hi && start.x[1].hi == end_.x[1].hi;
  if (closed) path_.d += " Z";
  return std::move(path_);
}

}  // namespace

Result<SvgPath> svg_path_from_curve(const NurbsCurve& curve, double max_error, SvgY y) {
  if (curve.dim() > 2) {
    return fail(ErrorCode::dimension_mismatch, "curve '" + curve.name() +
                                                   "': a path has 2 coordinates, the curve has " +
                                                   std::to_string(curve.dim()));
  }
  if (!(max_error > 0)) {
    return fail(ErrorCode::value_out_of_range, "curve '" + curve.name() + "': an error of " +
                                                   base::number_text(max_error) +
                                                   " must be above 0");
  }
  return PathWriter(curve, max_error, y).write();
}

}  // namespace knotwave::curves
