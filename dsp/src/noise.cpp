// SPDX-License-Identifier: MIT
#include "knotwave/dsp/noise.h"
