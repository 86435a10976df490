// SPDX-License-Identifier: MIT
// base is below curves.
#ifdef KNOTWAVE_BAD
#include "knotwave/curves/nurbs_curve.h"
#else
#include "knotwave/base/result.h"
#endif
