// SPDX-License-Identifier: MIT
#include "knotwave/engine/tuning.h"
