// SPDX-License-Identifier: MIT
// A part of the (u, v) plane inside closed curves: zones, loop regions, trimmed surfaces. See
// knotwave/curves/trim_region.h.
#pragma once
#include "knotwave/c/curve.h"

KW_BEGIN

typedef struct kw_trim_region kw_trim_region;

/// Loops of 2-D curves end to end: the first loop_sizes[0] of `curves` are loop 0, and so on; their
/// sum is curves_count. Counter-clockwise loops keep their inside, clockwise ones the outside, no
/// loop keeps everything. Ends meet within `tolerance`. [control]
KW_API kw_status kw_trim_region_create(const kw_curve* const* curves, size_t curves_count,
                                       const size_t* loop_sizes, size_t loop_count,
                                       double tolerance, kw_trim_region** out, kw_error** error);
KW_API void kw_trim_region_free(kw_trim_region* region);
/// A loop of one curve that keeps the inside of a rectangle. [control]
KW_API kw_status kw_curve_rectangle(double u_low, double u_high, double v_low, double v_high,
                                    kw_curve** out, kw_error** error);

/// Whether (u, v) is kept; borders are, NaN is not. [any]
KW_API bool kw_trim_region_contains(const kw_trim_region* region, double u, double v);
/// Whether what lies beyond all loops is kept. [any]
KW_API bool kw_trim_region_is_unbounded(const kw_trim_region* region);
/// What is kept at this v (or u): rows of low and high, in order; unbounded ends are infinite.
/// [control]
KW_API kw_status kw_trim_region_intervals_at_v(const kw_trim_region* region, double v,
                                               kw_doubles* out, kw_error** error);
KW_API kw_status kw_trim_region_intervals_at_u(const kw_trim_region* region, double u,
                                               kw_doubles* out, kw_error** error);

KW_END
