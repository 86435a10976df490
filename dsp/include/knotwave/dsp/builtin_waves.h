// SPDX-License-Identifier: MIT
// The four shapes everyone knows by name, as curves and as tables, for patches that draw none.
#pragma once
#include <span>
#include <string_view>

#include "knotwave/base/result.h"
#include "knotwave/curves/nurbs_curve.h"
#include "knotwave/dsp/wave_tables.h"

namespace knotwave::dsp {

/// "sine", "saw", "square", "triangle". [any]
std::span<const std::string_view> builtin_wave_names() noexcept;
bool is_builtin_wave(std::string_view name) noexcept;

/// One cycle over u in 0..1, values -1..1, as a curve for LFOs, envelopes and plots. [control]
/// sine: periodic, degree 7, 16 points, within 1e-9 of sin(2 pi u). saw: rises from -1 to 1.
/// square: 1 in the first half, -1 in the second, a declared jump at 0.5. triangle: 0 at 0, 1 at
/// 1/4, -1 at 3/4. Errors: unknown_name, with the names there are.
Result<curves::NurbsCurve> builtin_curve(std::string_view name);

/// The same shapes as a waveform; the sine is one exact harmonic. [control] Errors as above.
Result<WaveTables> builtin_wave(std::string_view name, const WaveTableOptions& options = {});

}  // namespace knotwave::dsp
