// SPDX-License-Identifier: MIT
#include "piece_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grid_kernel.h"
#include "next_double.h"

namespace knotwave::curves {
namespace {

constexpr int kDegree = kMaxPieceDegree;
constexpr int kNodes = kDegree + 1;

// Chebyshev-Lobatto places (1 - cos(pi i / 7)) / 2: the interpolant of degree 7 through them is
// near the best one, and it has both ends. Any nearby doubles do, as the nodes are where they are.
constexpr double kNode[kNodes] = {0,
                                  0.049515566048790434,
                                  0.18825509907063323,
                                  0.3887395330218428,
                                  0.6112604669781572,
                                  0.8117449009293668,
                                  0.9504844339512095,
                                  1};

// The same with value and slope at both ends: t^2 (1 - t)^2 times the inner factors has its five
// arches level, which is as small as they get (1.2 times those of the nodes above).
constexpr double kSmoothNode[kNodes] = {
    0, 0, 0.18643877146460758, 0.39029199957105914, 0.6097080004289408, 0.8135612285353924, 1, 1};

// Looks between two nodes. The error of a smooth target is one arch there, leaning at a double
// node, and few looks come near its top. What is above kAccepted is halved without a proof.
constexpr int kLooks = 6;
constexpr int kSmoothLooks = 8;
constexpr double kAccepted = 0.9;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct Piece {
  double u_a = 0;
  double u_b = 0;
  std::vector<double> coefficients;  // [outputs * kNodes]
  std::vector<double> right;         // value at u_b
};

/// Powers of t of the polynomial through (node[i], y[i]), with the slope by t at a node that is
/// there twice: Newton's divided differences, expanded from the last factor inwards.
void interpolate(std::span<const double> node, std::span<const DoubleDouble> y,
                 std::span<const DoubleDouble> slope, std::span<double> out) {
  DoubleDouble d[kNodes];
  std::copy(y.begin(), y.end(), d);
  for (int level = 1; level < kNodes; ++level) {
    for (int i = kNodes - 1; i >= level; --i) {
      const bool twice = node[at(i)] == node[at(i - level)];
      d[i] = twice ? slope[i == 1 ? 0 : 1]
                   : (d[i] - d[i - 1]) / DoubleDouble::difference(node[at(i)], node[at(i - level)]);
    }
  }
  DoubleDouble c[kNodes] = {d[kDegree]};
  for (int i = kDegree - 1, used = 1; i >= 0; --i, ++used) {
    for (int k = used; k > 0; --k) c[k] = c[k - 1] - c[k] * DoubleDouble(node[at(i)]);
    c[0] = d[i] - c[0] * DoubleDouble(node[at(i)]);
  }
  for (int k = 0; k < kNodes; ++k) out[at(k)] = c[k].hi;
}

class Fitter {
 public:
  Fitter(const FitTarget& target, const FitLimits& limits, const FitTarget* slopes)
      : target_(target),
        slopes_(slopes),
        node_(slopes != nullptr ? kSmoothNode : kNode),
        looks_(slopes != nullptr ? kSmoothLooks : kLooks),
        limits_(limits),
        outputs_(limits.low.size()),
        values_(outputs_) {}

  /// `left` [outputs] is the value at u_a, or empty.
  Piece fit(double u_a, double u_b, std::span<const double> left) {
    Piece piece{u_a, u_b, std::vector<double>(outputs_ * kNodes), {}};
    std::vector<DoubleDouble> y(outputs_ * kNodes);
    const DoubleDouble width = DoubleDouble::difference(u_b, u_a);
    for (int i = 0; i < kNodes; ++i) {
      // The last node is u_b itself, so that neighbours agree.
      target_(node_[at(i)] == 1 ? DoubleDouble(u_b)
                                : DoubleDouble(u_a) + width * DoubleDouble(node_[at(i)]),
              values_);
      for (std::size_t c = 0; c < outputs_; ++c) {
        if (node_[at(i)] == 0 && !left.empty()) values_[c] = left[c];
        if (i == kDegree) piece.right.push_back(values_[c].hi);
        y[c * kNodes + at(i)] = values_[c];
      }
    }
    std::vector<DoubleDouble> slopes(outputs_ * 2);
    for (std::size_t end = 0; slopes_ != nullptr && end < 2; ++end) {
      (*slopes_)(end == 0 ? u_a : u_b, values_);
      for (std::size_t c = 0; c < outputs_; ++c) slopes[c * 2 + end] = values_[c] * width;
    }
    for (std::size_t c = 0; c < outputs_; ++c) {
      interpolate(node_, std::span(y).subspan(c * kNodes, kNodes),
                  std::span(slopes).subspan(c * 2, 2),
                  std::span(piece.coefficients).subspan(c * kNodes, kNodes));
    }
    return piece;
  }

  /// Largest error at the looks, each of which is a double in [u_a, u_b); no further than one that
  /// is too large.
  double error(const Piece& piece) {
    double worst = 0;
    const double width = piece.u_b - piece.u_a;
    const auto look = [&](double u) {
      if (worst > kAccepted * limits_.max_error || !(u >= piece.u_a && u < piece.u_b)) return;
      worst = std::max(worst, error_at(piece, u));
    };
    look(next_up(piece.u_a));
    for (int i = 0; i < kDegree; ++i) {
      const double gap = node_[at(i + 1)] - node_[at(i)];
      for (int k = 0; gap > 0 && k < looks_; ++k) {
        const double t = node_[at(i)] + gap * (k + 0.5) / looks_;
        look(piece.u_a + width * t);
      }
    }
    look(next_down(piece.u_b));
    return worst;
  }

 private:
  double error_at(const Piece& piece, double u) {
    target_(u, values_);
    const double t = (u - piece.u_a) * (1.0 / (piece.u_b - piece.u_a));
    double worst = 0;
    for (std::size_t c = 0; c < outputs_; ++c) {
      const double y = clamp_to_hull(horner(piece.coefficients.data() + c * kNodes, kDegree, t),
                                     limits_.low[c], limits_.high[c]);
      worst = std::max(worst, std::abs((values_[c] - DoubleDouble(y)).hi));
    }
    return worst;
  }

  const FitTarget& target_;
  const FitTarget* slopes_;
  std::span<const double> node_;
  int looks_;
  const FitLimits& limits_;
  std::size_t outputs_;
  std::vector<DoubleDouble> values_;
};

}  // namespace

void FittedPieces::add(double u_a, double u_b, std::span<const double> piece) {
  if (breaks.empty()) breaks.push_back(u_a);
  breaks.push_back(u_b);
  coefficients.insert(coefficients.end(), piece.begin(), piece.end());
  right.clear();
}

void FittedPieces::note_error(double error, double u) {
  if (error <= max_error) return;
  max_error = error;
  worst_at = u;
}

void FittedPieces::lay_out(ProgramParts& parts) const {
  const int rows = count() * outputs;
  parts.degree = 0;
  for (int r = 0; r < rows; ++r) {
    for (int k = kDegree; k > parts.degree; --k) {
      if (coefficients[at(r * kNodes + k)] != 0) parts.degree = k;
    }
  }
  parts.breaks = breaks;
  parts.coefficients.clear();
  for (int r = 0; r < rows; ++r) {
    const auto row = std::span(coefficients).subspan(at(r * kNodes), at(parts.degree + 1));
    parts.coefficients.insert(parts.coefficients.end(), row.begin(), row.end());
  }
  parts.max_error = max_error;
}

bool fit_pieces(const FitTarget& target, double u_a, double u_b, const FitLimits& limits,
                const FitProof& proof, FittedPieces& pieces, const FitTarget* slopes) {
  Fitter fitter(target, limits, slopes);
  pieces.outputs = static_cast<int>(limits.low.size());
  std::vector<double> ends{u_b};  // right ends still to reach, the nearest last
  while (!ends.empty()) {
    if (pieces.count() + static_cast<int>(ends.size()) > limits.max_pieces) return false;
    const Piece piece = fitter.fit(u_a, ends.back(), pieces.right);
    const double middle = piece.u_a + 0.5 * (piece.u_b - piece.u_a);
    const bool can_halve = middle > piece.u_a && middle < piece.u_b;
    const double seen = fitter.error(piece);
    const double error =
        seen <= kAccepted * limits.max_error || !can_halve
            ? proof({piece.u_a, piece.u_b, piece.coefficients}, seen, pieces.max_error)
            : std::numeric_limits<double>::infinity();
    if (!(error <= limits.max_error) && can_halve) {
      ends.push_back(middle);
      continue;
    }
    pieces.add(piece.u_a, piece.u_b, piece.coefficients);
    pieces.right = piece.right;
    pieces.note_error(error, u_a);
    u_a = ends.back();
    ends.pop_back();
  }
  return true;
}

}  // namespace knotwave::curves
