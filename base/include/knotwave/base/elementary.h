// SPDX-License-Identifier: MIT
// Elementary functions that give the same bits everywhere: only + - * / and integer work, no libm,
// no fused multiply-add. Each comment is a contract that tests/base/elementary_test.cpp asserts
// against a table of 40-digit values. The inline bodies have no data-dependent branch, so a loop
// over them vectorises and stays equal to one call at a time.
#pragma once
#include <span>

#include "knotwave/base/rt.h"

namespace knotwave::base {

/// 2^x. [any] Range: all doubles; below -1022 returns 0 (no denormals), above 1024 the largest
/// finite double, NaN gives 1. Error <= 1 ulp.
double exp2(double x) KNOTWAVE_RT;

/// log2(x). [any] Range: normal positive doubles; x <= 0, denormal or NaN gives -1074.
/// Error <= 2 ulp, or 2^-60 absolute near x = 1.
double log2(double x) KNOTWAVE_RT;

struct SinCos {
  double sin;
  double cos;
};
/// sin and cos of 2 pi x, x in cycles. [any] Range |x| < 2^51 (reduced exactly); outside and for
/// NaN {0, 1}. Error <= 1 ulp of 1 absolute. Exact at multiples of 1/4.
SinCos sin_cos_cycles(double x) KNOTWAVE_RT;

/// tanh(x). [any] All doubles; NaN gives 0. Error <= 4 ulp.
double tanh(double x) KNOTWAVE_RT;

/// Frequency of a MIDI note, 440 * 2^((note - 69) / 12). [any] Any double. Error <= 3 ulp;
/// exact at A.
double note_to_hz(double note) KNOTWAVE_RT;

/// Gain of a level: 10^(db / 20). [any] Error <= 8 ulp in -200..200 dB.
double db_to_gain(double db) KNOTWAVE_RT;

/// Level of a gain: 20 log10(gain). [any] gain <= 0 gives -6463.2 (log2 = -1074 in dB) or below.
double gain_to_db(double gain) KNOTWAVE_RT;

/// out[i] = exp2(in[i]), same bits as one at a time; in and out may be the same. [audio]
void exp2(std::span<const double> in, std::span<double> out) KNOTWAVE_RT;

}  // namespace knotwave::base
