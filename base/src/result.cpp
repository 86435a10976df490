// SPDX-License-Identifier: MIT
#include "knotwave/base/result.h"
