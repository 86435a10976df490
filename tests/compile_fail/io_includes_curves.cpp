// SPDX-License-Identifier: MIT
// io knows no curve.
#ifdef KNOTWAVE_BAD
#include "knotwave/curves/nurbs_curve.h"
#else
#include "knotwave/base/midi_event.h"
#endif
