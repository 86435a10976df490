// SPDX-License-Identifier: MIT
#include "knotwave/curves/algorithms.h"
