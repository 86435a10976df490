// SPDX-License-Identifier: MIT
// dsp is below engine.
#ifdef KNOTWAVE_BAD
#include "knotwave/engine/engine.h"
#else
#include "knotwave/curves/nurbs_curve.h"
#endif
