// SPDX-License-Identifier: MIT
#include "knotwave/dsp/filter.h"
