// SPDX-License-Identifier: MIT
#include "knotwave/curves/compile.h"
