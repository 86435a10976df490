// SPDX-License-Identifier: MIT
// Two curves to one, and a curve to its slope, area or length. See knotwave/curves/combine.h and
// calculus.h. [control]
#pragma once
#include "knotwave/c/curve.h"

KW_BEGIN

/// `second` after `first`; ends farther apart than join_tolerance make a jump.
KW_API kw_status kw_curve_join(const kw_curve* first, const kw_curve* second, double join_tolerance,
                               kw_curve** out, kw_error** error);
/// Both with one degree, one knot vector and one count of points.
KW_API kw_status kw_curve_make_compatible(const kw_curve* first, const kw_curve* second,
                                          kw_curve** out_first, kw_curve** out_second,
                                          kw_error** error);
/// The same for any number: out[curves_count], each to be freed. All are made or none.
KW_API kw_status kw_curve_make_all_compatible(const kw_curve* const* curves, size_t curves_count,
                                              kw_curve** out, size_t out_count, kw_error** error);
/// (1 - amount) first + amount second, amount 0..1.
KW_API kw_status kw_curve_morph(const kw_curve* first, const kw_curve* second, double amount,
                                kw_curve** out, kw_error** error);
/// Pointwise, over equal domains.
KW_API kw_status kw_curve_sum(const kw_curve* first, const kw_curve* second, kw_curve** out,
                              kw_error** error);
KW_API kw_status kw_curve_product(const kw_curve* first, const kw_curve* second, kw_curve** out,
                                  kw_error** error);
/// outer(inner(u)).
KW_API kw_status kw_curve_compose(const kw_curve* outer, const kw_curve* inner, kw_curve** out,
                                  kw_error** error);

/// The derivative by u as a curve.
KW_API kw_status kw_curve_hodograph(const kw_curve* curve, kw_curve** out, kw_error** error);
/// start + integral from u_min to u, as a curve.
KW_API kw_status kw_curve_antiderivative(const kw_curve* curve, double start, kw_curve** out,
                                         kw_error** error);
/// Integral of one coordinate from u_a to u_b.
KW_API kw_status kw_curve_integral(const kw_curve* curve, double u_a, double u_b,
                                   int32_t coordinate, double* out, kw_error** error);
/// Length of the path between u_a and u_b, or of the graph of a scalar curve.
KW_API kw_status kw_curve_arc_length(const kw_curve* curve, double u_a, double u_b, double* out,
                                     kw_error** error);
/// The least u at which the path from u_min is `length` long.
KW_API kw_status kw_curve_parameter_at_length(const kw_curve* curve, double length, double* out,
                                              kw_error** error);

KW_END
