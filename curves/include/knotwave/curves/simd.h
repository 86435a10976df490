// SPDX-License-Identifier: MIT
// Which vector unit the kernels of all modules run on. Every unit gives the same bits; tests and
// benchmarks choose one.
#pragma once
#include <string>
#include <vector>

#include "knotwave/base/result.h"
#include "knotwave/base/rt.h"

namespace knotwave::curves {

enum class SimdLevel {
  best,      ///< the widest that this processor and this build have
  avx2,      ///< the 256-bit one of x86, also where AVX-512 is there
  baseline,  ///< what every processor that this build is for has
};
const char* to_string(SimdLevel level) noexcept;

/// All kernels take this level from now on. [control], before any audio runs.
/// Errors: unsupported (no AVX2 in this processor, or in this build), and the level stays.
Result<void> set_simd_level(SimdLevel level);
/// What was set; best until then. [any]
SimdLevel simd_level() KNOTWAVE_RT;
/// The levels that set_simd_level() takes on this machine, best first. [control]
std::vector<SimdLevel> simd_levels();
/// The vector unit in use, by Highway's name: AVX3 (AVX-512), AVX2, SSE4, NEON, EMU128 (plain C++)
/// ... [control]
const char* simd_level_name();

/// A family of kernels linked into this program, and the vector unit that its kernels in use now
/// were compiled for.
struct SimdKernelUse {
  std::string family, unit;
};
/// All of them, by name. [control]
std::vector<SimdKernelUse> simd_kernels_in_use();

}  // namespace knotwave::curves
