// SPDX-License-Identifier: MIT
// The floating-point state the engine computes in.
#pragma once
#include "knotwave/base/rt.h"

namespace knotwave::base {

/// While it lives: round to nearest, denormals kept or flushed as asked, traps off; the state
/// before is restored at the end. [audio] Where the processor has no such state it does nothing.
class FpStateGuard {
 public:
  enum class Denormals { kept, flushed };
  explicit FpStateGuard(Denormals denormals = Denormals::flushed) KNOTWAVE_RT;
  ~FpStateGuard();
  FpStateGuard(const FpStateGuard&) = delete;
  FpStateGuard& operator=(const FpStateGuard&) = delete;

 private:
  unsigned long long saved_;
};

/// States snap to zero below 1e-20, so flushing or keeping denormals gives the same bits. [audio]
template <class Float>
constexpr Float snap_to_zero(Float x) KNOTWAVE_RT {
  return (x < Float(1e-20) && x > Float(-1e-20)) ? Float(0) : x;
}

}  // namespace knotwave::base
