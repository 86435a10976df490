// SPDX-License-Identifier: MIT
// The elementary functions of a voice over many samples, a vector at a time (Highway). Bit for bit
// those of base/elementary.h and base/time.h called for each sample; any split gives the same bits.
#pragma once
#include <span>

#include "knotwave/base/rt.h"
#include "knotwave/base/time.h"

namespace knotwave::dsp {

/// out[i] = base::exp2(in[i]); as long as the shorter. in and out may be the same. [audio]
void exp2(std::span<const double> in, std::span<double> out) KNOTWAVE_RT;

/// out[i] = base::db_to_gain(in[i]); as long as the shorter. in and out may be the same. [audio]
void db_to_gain(std::span<const double> in, std::span<double> out) KNOTWAVE_RT;

/// out[i] = base::phase_increment(base::note_to_hz(notes[i]), rate_hz); as long as the shorter.
/// [audio]
void note_increments(std::span<const double> notes, double rate_hz,
                     std::span<base::Phase> out) KNOTWAVE_RT;

/// out[i] = origin + (first + i * increment).cycles() * width. [audio]
void phase_ramp(base::Phase first, base::Phase increment, double origin, double width,
                std::span<double> out) KNOTWAVE_RT;

}  // namespace knotwave::dsp
