// SPDX-License-Identifier: MIT
#include "knotwave/engine/patch.h"
