// SPDX-License-Identifier: MIT
// The control register of the processor's floating-point unit: MXCSR on x86, FPCR on 64-bit ARM.
#include "knotwave/base/fp_state.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace knotwave::base {
namespace {

#if defined(__SSE2__)
constexpr unsigned kTrapsOffToNearest = 0x1F80;
constexpr unsigned kFlushResultsAndInputs = 0x8040;
unsigned long long read_state() { return _mm_getcsr(); }
void write_state(unsigned long long state) { _mm_setcsr(static_cast<unsigned>(state)); }
#elif defined(__aarch64__)
constexpr unsigned long long kTrapsOffToNearest = 0;
constexpr unsigned long long kFlushResultsAndInputs = 1ULL << 24;
unsigned long long read_state() {
  unsigned long long state = 0;
  asm volatile("mrs %0, fpcr" : "=r"(state));
  return state;
}
void write_state(unsigned long long state) { asm volatile("msr fpcr, %0" : : "r"(state)); }
#else
constexpr unsigned kTrapsOffToNearest = 0;
constexpr unsigned kFlushResultsAndInputs = 0;
unsigned long long read_state() { return 0; }
void write_state(unsigned long long) {}
#endif

}  // namespace

FpStateGuard::FpStateGuard(Denormals denormals) KNOTWAVE_RT : saved_(read_state()) {
  write_state(denormals == Denormals::flushed ? kTrapsOffToNearest | kFlushResultsAndInputs
                                              : kTrapsOffToNearest);
}

FpStateGuard::~FpStateGuard() { write_state(saved_); }

}  // namespace knotwave::base
