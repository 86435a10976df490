// SPDX-License-Identifier: MIT
#include "knotwave/engine/engine.h"
