// SPDX-License-Identifier: MIT
#include "knotwave/dsp/crossfade.h"
