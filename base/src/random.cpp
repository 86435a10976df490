// SPDX-License-Identifier: MIT
#include "knotwave/base/random.h"
