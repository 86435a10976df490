// SPDX-License-Identifier: MIT
#include "knotwave/dsp/envelope.h"
