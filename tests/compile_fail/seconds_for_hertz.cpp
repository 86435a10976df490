// SPDX-License-Identifier: MIT
// A time where a frequency is asked.
#include "knotwave/base/units.h"

using namespace knotwave::base::literals;

double period_of(knotwave::base::Hertz frequency) { return 1 / frequency.value; }

#ifdef KNOTWAVE_BAD
double period() { return period_of(30_ms); }
#else
double period() { return period_of(440_Hz); }
#endif
