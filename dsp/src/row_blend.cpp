// SPDX-License-Identifier: MIT
// How rows are blended along v: as polynomials of the position, one set a stretch.
#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <string>

#include "knotwave/base/elementary.h"

#include "wave_table_builder.h"

namespace knotwave::dsp {
namespace {

using Polynomial = WaveTableBuilder::Polynomial;

constexpr int kMaxRowsFitted = 1024;
constexpr int kMaxHalvings = 16;

std::string text(double number) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, number).ptr};
}

/// polynomial * (constant + slope * t), ascending powers.
Polynomial times_linear(const Polynomial& p, double constant, double slope) {
  Polynomial out{};
  for (std::size_t k = 0; k < p.size(); ++k) {
    out[k] += p[k] * constant;
    if (k > 0) out[k] += p[k - 1] * slope;
  }
  return out;
}

/// The degree + 1 basis functions of one knot span in t = (v - left) / width: Cox-de Boor on
/// polynomials (The NURBS Book, 2.5).
std::array<Polynomial, WaveTables::kMaxBlended> span_basis(std::span<const double> knots,
                                                           int degree, std::size_t span) {
  const double left = knots[span];
  const double width = knots[span + 1] - left;
  std::array<Polynomial, WaveTables::kMaxBlended> basis{};
  basis[0][0] = 1;
  for (int d = 1; d <= degree; ++d) {
    const auto width_d = static_cast<std::size_t>(d);
    std::array<Polynomial, WaveTables::kMaxBlended> raised{};
    for (std::size_t r = 0; r < width_d; ++r) {  // lower function r feeds r and r + 1
      const double from = knots[span + 1 + r - width_d];
      const double to = knots[span + 1 + r];
      const Polynomial up =
          times_linear(basis[r], (left - from) / (to - from), width / (to - from));
      const Polynomial down =
          times_linear(basis[r], (to - left) / (to - from), -width / (to - from));
      for (std::size_t k = 0; k < up.size(); ++k) {
        raised[r][k] += down[k];
        raised[r + 1][k] += up[k];
      }
    }
    basis = raised;
  }
  return basis;
}

/// Lagrange polynomials through the fit nodes.
std::array<Polynomial, WaveTableBuilder::kFitRows> lagrange_basis() {
  std::array<Polynomial, WaveTableBuilder::kFitRows> basis{};
  for (int j = 0; j < WaveTableBuilder::kFitRows; ++j) {
    Polynomial p{};
    p[0] = 1;
    for (int k = 0; k < WaveTableBuilder::kFitRows; ++k) {
      if (k == j) continue;
      const double gap = WaveTableBuilder::fit_node(j) - WaveTableBuilder::fit_node(k);
      p = times_linear(p, -WaveTableBuilder::fit_node(k) / gap, 1 / gap);
    }
    basis[static_cast<std::size_t>(j)] = p;
  }
  return basis;
}

/// Sum of the harmonics' amplitudes: a bound of the peak.
double amplitude_sum(std::span<const std::complex<double>> harmonics) {
  double sum = 0;
  for (std::size_t n = 1; n < harmonics.size(); ++n)
    sum += 2 * std::abs(harmonics[n].real()) + 2 * std::abs(harmonics[n].imag());
  return sum;
}

}  // namespace

void WaveTableBuilder::add_blend(double start, WaveTables::BlendPiece piece,
                                 std::span<const Polynomial> weights) {
  for (std::size_t k = 0; k < WaveTables::kMaxBlended; ++k) {
    for (std::size_t r = 0; r < weights.size(); ++r) piece.power[k][r] = weights[r][k];
  }
  tables_.blend_starts_.push_back(start);
  tables_.blends_.push_back(piece);
}

void WaveTableBuilder::blend_by_basis(std::span<const double> knots, int degree) {
  KNOTWAVE_ASSERT(degree < WaveTables::kMaxBlended);
  const auto p = static_cast<std::size_t>(degree);
  const std::size_t rows = knots.size() - p - 1;
  const double low = knots[p];
  const double length = knots[rows] - low;
  tables_.blends_.clear();
  tables_.blend_starts_.clear();
  for (std::size_t span = p; span < rows; ++span) {
    const double width = knots[span + 1] - knots[span];
    if (!(width > 0)) continue;
    const auto basis = span_basis(knots, degree, span);
    WaveTables::BlendPiece piece;
    piece.inverse_width = length / width;
    piece.first = static_cast<int>(span - p);
    piece.count = degree + 1;
    piece.degree = degree;
    add_blend((knots[span] - low) / length, piece, basis);
  }
}

void WaveTableBuilder::blend_linearly() {
  if (rows_ == 1) {
    tables_.blends_.assign(1, WaveTables::BlendPiece());
    tables_.blend_starts_.assign(1, 0.0);
    return;
  }
  std::vector<double> knots = {0};
  for (int row = 0; row < rows_; ++row) knots.push_back(row);
  knots.push_back(rows_ - 1);
  blend_by_basis(knots, 1);
}

void WaveTableBuilder::blend_by_interpolation(double start, double end, int first) {
  const auto basis = lagrange_basis();
  WaveTables::BlendPiece piece;
  piece.inverse_width = 1 / (end - start);
  piece.first = first;
  piece.count = kFitRows;
  piece.degree = kFitRows - 1;
  add_blend(start, piece, basis);
}

double WaveTableBuilder::fit_node(int k) {
  return 0.5 - 0.5 * base::sin_cos_cycles(0.5 * k / (kFitRows - 1)).cos;
}

std::array<double, WaveTableBuilder::kFitRows> WaveTableBuilder::fit_weights(double t) {
  const auto basis = lagrange_basis();
  std::array<double, kFitRows> weights{};
  for (std::size_t r = 0; r < weights.size(); ++r) {
    for (std::size_t k = kFitRows; k-- > 0;) weights[r] = weights[r] * t + basis[r][k];
  }
  return weights;
}

namespace {

/// The rows of one fit, kept by position so that shared places are compiled once.
class RowFit {
 public:
  RowFit(const RowAt& row_at, double max_error) : row_at_(row_at), max_error_(max_error) {}

  Result<const RowHarmonics*> row(double position) {
    const auto found = rows_.find(position);
    if (found != rows_.end()) return &found->second;
    Result<RowHarmonics> made = row_at_(position);
    if (!made) return made.error();
    return &rows_.emplace(position, std::move(*made)).first->second;
  }

  /// Largest error of interpolating over start..end, between the nodes, re the peak.
  Result<double> error(double start, double end) {
    double worst = 0;
    for (int k = 0; k + 1 < WaveTableBuilder::kFitRows; ++k) {
      const double t = 0.5 * (WaveTableBuilder::fit_node(k) + WaveTableBuilder::fit_node(k + 1));
      const auto weights = WaveTableBuilder::fit_weights(t);
      auto true_row = row(start + (end - start) * t);
      if (!true_row) return true_row.error();
      RowHarmonics difference = **true_row;
      for (int j = 0; j < WaveTableBuilder::kFitRows; ++j) {
        auto node = row(start + (end - start) * WaveTableBuilder::fit_node(j));
        if (!node) return node.error();
        for (std::size_t c = 0; c < difference.size(); ++c) {
          for (std::size_t n = 0; n < difference[c].size(); ++n) {
            difference[c][n] -= weights[static_cast<std::size_t>(j)] * (**node)[c][n];
          }
        }
      }
      for (std::size_t c = 0; c < difference.size(); ++c) {
        const double peak = amplitude_sum((**true_row)[c]);
        if (peak > 0) worst = std::max(worst, amplitude_sum(difference[c]) / peak);
      }
    }
    return worst;
  }

  Result<void> fit(double start, double end, int halvings, WaveTableBuilder& builder) {
    const Result<double> found = error(start, end);
    if (!found) return found.error();
    if (*found > max_error_) {
      if (halvings == kMaxHalvings || builder.row_count() >= kMaxRowsFitted) {
        return fail(ErrorCode::error_bound_missed,
                    "between positions " + text(start) + " and " + text(end) +
                        " blended rows differ from the curve by " + text(*found) +
                        " of the peak, more than the " + text(max_error_) + " asked for");
      }
      const double middle = 0.5 * (start + end);
      if (Result<void> half = fit(start, middle, halvings + 1, builder); !half) return half;
      return fit(middle, end, halvings + 1, builder);
    }
    builder.note_fit_error(*found);
    const bool begins = builder.row_count() == 0;
    const int first = begins ? 0 : builder.row_count() - 1;
    for (int j = begins ? 0 : 1; j < WaveTableBuilder::kFitRows; ++j) {
      auto node = row(start + (end - start) * WaveTableBuilder::fit_node(j));
      if (!node) return node.error();
      builder.add_row(**node);
    }
    builder.blend_by_interpolation(start, end, first);
    rows_.erase(rows_.begin(), rows_.lower_bound(end));
    return {};
  }

 private:
  const RowAt& row_at_;
  double max_error_;
  std::map<double, RowHarmonics> rows_;
};

}  // namespace

Result<void> fit_rows(const RowAt& row_at, std::span<const double> breaks, double max_error,
                      WaveTableBuilder& builder) {
  RowFit fit(row_at, max_error);
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    if (Result<void> done = fit.fit(breaks[k], breaks[k + 1], 0, builder); !done) return done;
  }
  return {};
}

}  // namespace knotwave::dsp
