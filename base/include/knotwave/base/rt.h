// SPDX-License-Identifier: MIT
// The audio-thread word and the assertion. See docs/realtime-rules.md.
#pragma once

/// KNOTWAVE_RT goes last in a signature: the function may run on the audio thread. It never
/// allocates, locks, blocks, throws or touches a file. Compilers that know the attribute check it.
#if defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::nonblocking)
#define KNOTWAVE_RT noexcept [[clang::nonblocking]]
#endif
#endif
#ifndef KNOTWAVE_RT
#define KNOTWAVE_RT noexcept
#endif

namespace knotwave::base {
/// Prints the failed claim and aborts. [any] Called by KNOTWAVE_ASSERT only.
[[noreturn]] void assertion_failed(const char* claim, const char* file, int line) noexcept;
}  // namespace knotwave::base

/// A claim only a programming error can break. On unless KNOTWAVE_ASSERTS=OFF (release preset).
#ifdef KNOTWAVE_ASSERTS
#define KNOTWAVE_ASSERT(claim) \
  ((claim) ? void(0) : ::knotwave::base::assertion_failed(#claim, __FILE__, __LINE__))
#else
#define KNOTWAVE_ASSERT(claim) void(0)
#endif
