// SPDX-License-Identifier: MIT
#include "knotwave/dsp/lfo.h"
