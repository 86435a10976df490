// SPDX-License-Identifier: MIT
// Any smooth function as polynomial pieces of degree kMaxPieceDegree, by bisection until the
// error is proved small enough. Private to curves. [control]
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "knotwave/base/result.h"

#include "double_double.h"
#include "program_builder.h"

namespace knotwave::curves {

/// What pieces are fitted to: all outputs at u, right to well below the asked error.
using FitTarget = std::function<void(DoubleDouble u, std::span<DoubleDouble> out)>;

struct FitLimits {
  double max_error = 1e-7;
  int max_pieces = 4096;
  std::vector<double> low, high;  ///< hull, one pair an output: pieces are compared clamped
};

/// Pieces after one another, and how far they are from the target.
struct FittedPieces {
  int outputs = 1;
  std::vector<double> breaks;        ///< [pieces + 1]
  std::vector<double> coefficients;  ///< [pieces * outputs * (kMaxPieceDegree + 1)]
  std::vector<double> right;  ///< value at the last break, where the next piece begins; empty: at
                              ///< the target's own value there
  double max_error = 0;
  double worst_at = 0;  ///< where the piece begins that has it

  int count() const { return breaks.empty() ? 0 : static_cast<int>(breaks.size()) - 1; }
  /// One piece of any degree up to kMaxPieceDegree; breaks must go on from the last one.
  void add(double u_a, double u_b, std::span<const double> piece);
  void note_error(double error, double u);
  /// Breaks, coefficients, degree (the highest power any piece uses) and error.
  void lay_out(ProgramParts& parts) const;
};

/// A fitted piece on [u_a, u_b).
struct FitPiece {
  double u_a = 0;
  double u_b = 0;
  std::span<const double> coefficients;  ///< [outputs * (kMaxPieceDegree + 1)]
};

/// A bound on the error of a piece as it is played, rounding included, at every double in
/// [u_a, u_b), over all outputs: infinity or the bound itself where it is above
/// FitLimits::max_error. `found` has been seen by looking; below that and below `settled` it need
/// not be tight.
using FitProof = std::function<double(const FitPiece& piece, double found, double settled)>;

/// Appends pieces of `target` over [u_a, u_b]; neighbours share the value at their break to the
/// bit, and with `slopes` (dy/du of all outputs) the slope to rounding. Each piece is looked at,
/// then proved, and halved where either fails. A piece between two neighbouring doubles is taken,
/// its error noted even if it is too large. False when max_pieces are not enough.
bool fit_pieces(const FitTarget& target, double u_a, double u_b, const FitLimits& limits,
                const FitProof& proof, FittedPieces& pieces, const FitTarget* slopes = nullptr);

}  // namespace knotwave::curves
