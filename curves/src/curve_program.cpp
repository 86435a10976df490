// SPDX-License-Identifier: MIT
#include "knotwave/curves/curve_program.h"
