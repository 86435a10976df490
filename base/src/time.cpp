// SPDX-License-Identifier: MIT
#include "knotwave/base/time.h"
