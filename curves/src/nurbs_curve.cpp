// SPDX-License-Identifier: MIT
#include "knotwave/curves/nurbs_curve.h"
