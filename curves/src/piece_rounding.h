// SPDX-License-Identifier: MIT
// What playing an exact piece rounds away, proved, and shorter pieces where that is too much.
// Private to curves. [control]
#pragma once
#include "compile_parts.h"

namespace knotwave::curves {

/// What piece `index` of parts without controls can be from the curve: a running bound of Horner,
/// of t and of the quotient, over parts of the piece, halved while it is above `asked`. Infinity
/// where it stays above that, because D nearly cancels; with asked = infinity, a bound always, the
/// width of the hull at worst.
double piece_rounding(const ProgramParts& parts, std::size_t index, double asked);

/// The pieces of exact_parts() without controls, those halved that round away more than asked: a
/// shorter piece has weights nearer to each other. False where max_pieces are not enough. Sets
/// max_error.
bool cut_to_rounding(const NurbsCurve& curve, const CompileOptions& options, ProgramParts& parts);

}  // namespace knotwave::curves
