// SPDX-License-Identifier: MIT
#include "knotwave/curves/plot.h"
