// SPDX-License-Identifier: MIT
#include "knotwave/dsp/shaper.h"
