// SPDX-License-Identifier: MIT
#include "piece_rounding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bernstein.h"
#include "piece_bounds.h"

namespace knotwave::curves {
namespace {

constexpr double kUnit = 0x1p-53 * (1 + 0x1p-40);
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// What Bernstein coefficients by doubles are off by, of the sum of |c|.
constexpr double kConversion = 0x1p-48;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// What Horner holds after each step, s_k = c_k + t (c_{k+1} + ...), as Bernstein coefficients over
/// a part: of s_k entries 0 .. degree - k.
using Steps = std::array<PieceRow, kMaxPieceDegree + 1>;

Steps steps_of(std::span<const double> row) {
  Steps steps{};
  for (std::size_t k = 0; k < row.size(); ++k) steps[k] = bernstein_row(row.subspan(k));
  return steps;
}

double largest_of(const PieceRow& row, std::size_t count) {
  double largest = 0;
  for (std::size_t j = 0; j < count; ++j) largest = std::max(largest, std::abs(row[j]));
  return largest;
}

/// Rows of a piece over [t0, t1].
struct Part {
  std::vector<Steps> rows;
  double t0 = 0;
  double t1 = 1;
  int halvings = 0;
};

/// `part` becomes its left half, the right one is returned.
Part halved(Part& part, std::size_t powers) {
  Part right = part;
  for (std::size_t r = 0; r < part.rows.size(); ++r) {
    for (std::size_t k = 0; k < powers; ++k) {
      PieceRow& b = right.rows[r][k];
      for (std::size_t level = 1; level < powers - k; ++level) {
        for (std::size_t j = 0; j + level < powers - k; ++j) b[j] = 0.5 * (b[j] + b[j + 1]);
        part.rows[r][k][level] = b[0];
      }
    }
  }
  right.t0 = part.t1 = 0.5 * (part.t0 + part.t1);
  right.halvings = ++part.halvings;
  return right;
}

class PieceRounding {
 public:
  PieceRounding(const ProgramParts& parts, std::size_t index)
      : parts_(parts), piece_(std::span(parts.coefficients).subspan(index * parts.piece_size())) {}

  double bound(double asked) const {
    std::vector<Part> open(1);
    for (std::size_t r = 0; r < parts_.rows(); ++r) open[0].rows.push_back(steps_of(row(r)));
    double worst = 0;
    for (int seen = 0; !open.empty(); ++seen) {
      Part part = std::move(open.back());
      open.pop_back();
      const double error = error_over(part);
      // A few halvings for a tight bound, more for one that is small enough.
      const bool is_last = part.halvings == (error > asked ? kMostHalvings : kTight);
      if (error <= std::max(worst, kEnough * largest()) || is_last || seen >= kMostParts) {
        worst = std::max(worst, error);
        if (worst > asked) return kInfinity;
      } else {
        Part right = halved(part, parts_.powers());
        open.push_back(std::move(part));
        open.push_back(std::move(right));  // first: there sums of powers cancel
      }
    }
    return worst;
  }

 private:
  static constexpr int kTight = 3;
  static constexpr int kMostHalvings = 40;
  static constexpr int kMostParts = 64;
  static constexpr double kEnough = 0x1p-46;

  std::span<const double> row(std::size_t r) const {
    return piece_.subspan(r * parts_.powers(), parts_.powers());
  }
  double largest(std::size_t c) const {
    return std::max(std::abs(parts_.low[c]), std::abs(parts_.high[c]));
  }
  double largest() const {
    double most = 0;
    for (std::size_t c = 0; c < parts_.low.size(); ++c) most = std::max(most, largest(c));
    return most;
  }
  double size_of(std::size_t r) const {
    double sum = 0;
    for (const double c : row(r)) sum += std::abs(c);
    return sum;
  }

  /// In units of 2^-53. A step is a product and a sum, each off by 1 of its result; each
  /// coefficient is off by 1 of itself, t by 4 of itself (a difference times an inverse of a
  /// width). Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., 5.1.
  double units(const Part& part, std::size_t r) const {
    const std::size_t powers = parts_.powers();
    const double slack = kConversion * size_of(r);
    double sum = 0, held = 0;
    for (std::size_t k = powers; k-- > 0;) {
      const double now = largest_of(part.rows[r][k], powers - k) + slack;
      if (k + 1 < powers) sum = part.t1 * (sum + held) + now;
      held = now;
    }
    double power = 1;
    for (const double c : row(r)) {
      sum += power * std::abs(c);
      power *= part.t1;
    }
    const PieceRow& b = part.rows[r][0];
    double rise = 0;
    for (std::size_t j = 1; j < powers; ++j) rise = std::max(rise, std::abs(b[j] - b[j - 1]));
    const double slope = double(powers - 1) * (rise / (part.t1 - part.t0)) + slack;
    return sum + 4 * part.t1 * slope;
  }

  double error_over(const Part& part) const {
    const std::size_t dim = at(parts_.dim);
    double worst = 0;
    const double off = parts_.rational ? units(part, dim) : 0;
    double least = 1;
    if (parts_.rational) {
      const PieceRow& weights = part.rows[dim][0];
      least = *std::min_element(weights.begin(), weights.begin() + parts_.degree + 1) -
              kConversion * size_of(dim) - kUnit * off;
    }
    for (std::size_t c = 0; c < dim; ++c) {
      // What N and D are off by, over the least D there may be; 1 of the division, 1 of the value
      // it is compared with. Clamping keeps both in the hull.
      const double width = parts_.high[c] - parts_.low[c];
      const double error =
          least > 0 ? kUnit * ((units(part, c) + largest(c) * off) / least + 2 * largest(c))
                    : width;
      worst = std::max(worst, std::min(error, width + kUnit * largest(c)));
    }
    return worst;
  }

  const ProgramParts& parts_;
  std::span<const double> piece_;
};

/// Rows of a span between u_a and u_b, rounded, to out.
void append_piece(const SpanPolynomial& span, double u_a, double u_b, const ProgramParts& parts,
                  std::vector<double>& out) {
  const DoubleDouble width = DoubleDouble::difference(span.u1, span.u0);
  const DoubleDouble t0 = DoubleDouble::difference(u_a, span.u0) / width;
  const DoubleDouble t1 = DoubleDouble::difference(u_b, span.u0) / width;
  const DoubleDouble weight = parts.rational ? DoubleDouble(1.0) : span.bezier_row(span.dim)[0];
  std::vector<DoubleDouble> powers(parts.powers());
  for (std::size_t r = 0; r < parts.rows(); ++r) {
    const auto row = span.bezier_row(static_cast<int>(r));
    Bernstein part = part_of(Bernstein(row.begin(), row.end()), t0, t1);
    bernstein_to_powers(part, powers);
    for (const DoubleDouble c : powers) out.push_back((c / weight).hi);
  }
}

}  // namespace

double piece_rounding(const ProgramParts& parts, std::size_t index, double asked) {
  return PieceRounding(parts, index).bound(asked);
}

bool cut_to_rounding(const NurbsCurve& curve, const CompileOptions& options, ProgramParts& parts) {
  ProgramParts cut = parts;  // the hull and what else all pieces share
  cut.breaks.assign(1, parts.breaks.front());
  cut.coefficients.clear();
  ProgramParts one = cut;  // the piece looked at
  const std::vector<SpanPolynomial> spans = span_polynomials(HomogeneousCurve(curve));
  for (std::size_t i = 0; i < parts.pieces(); ++i) {
    const auto from = parts.coefficients.begin() + std::ptrdiff_t(i * parts.piece_size());
    one.coefficients.assign(from, from + std::ptrdiff_t(parts.piece_size()));
    for (std::vector<double> ends{parts.breaks[i + 1]}; !ends.empty();) {
      if (cut.pieces() + ends.size() > at(options.max_pieces)) return false;
      const double u_a = cut.breaks.back(), u_b = ends.back();
      const double error = piece_rounding(one, 0, options.max_error);
      if (error <= options.max_error) {
        cut.breaks.push_back(u_b);
        cut.coefficients.insert(cut.coefficients.end(), one.coefficients.begin(),
                                one.coefficients.end());
        cut.max_error = std::max(cut.max_error, error);
        ends.pop_back();
      } else {
        const double middle = u_a + 0.5 * (u_b - u_a);
        if (!(middle > u_a && middle < u_b)) return false;
        ends.push_back(middle);
      }
      if (ends.empty()) break;
      one.coefficients.clear();
      append_piece(spans[i], cut.breaks.back(), ends.back(), parts, one.coefficients);
    }
  }
  parts = std::move(cut);
  return true;
}

}  // namespace knotwave::curves
