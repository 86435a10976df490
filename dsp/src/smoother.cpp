// SPDX-License-Identifier: MIT
#include "knotwave/dsp/smoother.h"
