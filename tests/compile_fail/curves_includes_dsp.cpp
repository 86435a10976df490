// SPDX-License-Identifier: MIT
// curves is below dsp.
#ifdef KNOTWAVE_BAD
#include "knotwave/dsp/smoother.h"
#else
#include "knotwave/base/result.h"
#endif
