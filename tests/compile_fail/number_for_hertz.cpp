// SPDX-License-Identifier: MIT
// A bare number where a frequency is asked: an aggregate is made by braces, never by conversion.
#include "knotwave/base/units.h"

double period_of(knotwave::base::Hertz frequency) { return 1 / frequency.value; }

#ifdef KNOTWAVE_BAD
double period() { return period_of(440.0); }
#else
double period() { return period_of({440.0}); }
#endif
