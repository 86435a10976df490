// SPDX-License-Identifier: MIT
#include "knotwave/dsp/oscillator.h"
