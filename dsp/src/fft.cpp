// SPDX-License-Identifier: MIT
#include "knotwave/dsp/fft.h"
