// SPDX-License-Identifier: MIT
#include "knotwave/dsp/wave_tables.h"
