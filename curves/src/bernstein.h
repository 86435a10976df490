// SPDX-License-Identifier: MIT
// Polynomials on [0, 1] by their Bernstein coefficients, in double-double. Private to curves.
// [control]
// Source: Farouki & Rajan, Algorithms for polynomials in Bernstein form, CAGD 5 (1988).
#pragma once
#include <span>
#include <vector>

#include "double_double.h"

namespace knotwave::curves {

using Bernstein = std::vector<DoubleDouble>;  ///< [degree+1]

Bernstein operator*(const Bernstein& a, const Bernstein& b);
/// Of the same degree.
Bernstein operator+(const Bernstein& a, const Bernstein& b);
Bernstein operator-(const Bernstein& a, const Bernstein& b);
Bernstein derivative(const Bernstein& a);
/// de Casteljau at 1/2: `a` becomes its left half, over [0, 1] again; the right one is returned.
Bernstein halve(Bernstein& a);
/// Powers of 2 t - 1, the distance from the middle in half widths: [degree+1], power 0 first.
std::vector<DoubleDouble> centered_powers(Bernstein a);
/// The same over [t0, t1], 0 <= t0 < t1 <= 1.
Bernstein part_of(Bernstein a, DoubleDouble t0, DoubleDouble t1);

/// Its value at t over max(t, 1-t)^degree: the sign, and quotients of equal degree, are right.
DoubleDouble scaled_value(std::span<const DoubleDouble> a, DoubleDouble t) noexcept;
/// numerator / denominator at t, of equal degree; at 0 and 1 the quotient of the end coefficients.
DoubleDouble quotient_at(const Bernstein& numerator, const Bernstein& denominator,
                         DoubleDouble t) noexcept;

/// Every t in (0, 1) where the sign changes, in order, within 2^-53 of t of a place where a
/// polynomial does whose coefficients are 2^-96 of `terms` away: for each coefficient how large the
/// terms are that it is the sum of. One bound for all would lose the roots where weights make the
/// polynomial small. Found by variation diminishing: a part whose coefficients change sign once has
/// one root, others are halved, down to 2^-50 of t or 2^-64 (where roots stay together, the part
/// counts as one place).
std::vector<double> sign_changes(const Bernstein& a, const Bernstein& terms);
/// n (w_i + w_{i+1}): how large the terms of derivative() are for coefficients up to `w`.
Bernstein derivative_terms(const Bernstein& w);

}  // namespace knotwave::curves
